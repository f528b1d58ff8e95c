// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/geometry/regions.h"
#include "osteon/infer/rignet.h"
#include "osteon/mesh/triangle_mesh.h"
#include "osteon/pipelines/joint_extraction.h"

namespace osteon::pipelines {

// How many joints a mesh of so many triangles is likely to want: artists who model finely rig finely. Over the 63 groups of the training
// characters the logarithms of both correlate by 0.6. Detail 0.5 is the expected number, 0 a quarter and 1 four times as many.
float expected_joints(std::size_t triangles, float detail);

// Where the vertices of a working mesh see joints, in its frame. The networks are shown the character several times: as it is, mirrored,
// and both from behind, turned and stretched a little; all answers are heard together, so that one chance error counts less, and so that
// nobody has to know the front: (4V) candidates, V for each view. Where there are two voting networks the second one sees it from behind:
// it costs no more time than one for all, and they err in different places. `joints`: how many the rig shall have, roughly. `graph` and
// `regions` are those of `mesh`. Pre: `mesh` is normalised.
JointCandidates joint_votes(const TriangleMesh& mesh, const nets::MeshArrays& graph, const geometry::Regions& regions,
                            const infer::RignetModels& models, float joints);

}  // namespace osteon::pipelines
