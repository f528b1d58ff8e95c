// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "osteon/geometry/mirror_pairs.h"
#include "osteon/mesh/triangle_mesh.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

// The skin of a symmetric skeleton, symmetric too.
namespace osteon::pipelines {

// Each joint's mirror partner: the joint nearest to its image, within 0.01, and of several at one place the one with the partner of its
// parent for a parent, in joint order; a joint on the plane is its own. Empty unless the whole tree is its own mirror image: everybody is
// its partner's partner, and the partners' parents are partners (but for a root with a partner).
// Pre: `positions` are in the frame and unit of `plane`, longest side of the character 1.
std::optional<PerJoint<JointId>> mirror_partners(const Skeleton& skeleton, const PerJoint<Vec3f>& positions, const Plane& plane);

// The mean of weights (V,J) of the vertices of `mesh` and their mirror image: at the point of the surface nearest to the vertex's image,
// the joints changed for their partners. Vertices whose image is farther than 0.02 from the surface keep what they have.
Matrix mean_with_image(const Matrix& weights, const TriangleMesh& mesh, const Plane& plane, const PerJoint<JointId>& partner);

// Makes the weights of mirrored vertices equal, bit by bit, but for the joints, which are partners: both get the mean of the two rows.
// `from_original`: row of `weights` -> vertex of the mesh that `pairs` are of. At most `max_influences` joints stay; of joints with equal
// weights all stay or none, so vertices on the plane are symmetric in themselves (unless that left nothing).
SkinWeights mirrored_exactly(const SkinWeights& weights, const PerVertex<VertexId>& from_original,
                             const PerVertex<VertexId>& vertex_partner, const PerJoint<JointId>& joint_partner, std::size_t max_influences);

}  // namespace osteon::pipelines
