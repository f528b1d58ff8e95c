// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/infer/rignet.h"
#include "osteon/mesh/triangle_mesh.h"
#include "osteon/pipelines/joint_extraction.h"

namespace osteon::pipelines {

// Where the vertices of a working mesh see joints, in its frame. The network is shown the character several times: as it is, mirrored, and
// both from behind, turned and stretched a little; all answers are heard together, so that one chance error counts less, and so that nobody
// has to know the front: (4V) candidates, V for each view. `graph` is that of `mesh`. Pre: `mesh` is normalised.
JointCandidates joint_votes(const TriangleMesh& mesh, const nets::MeshArrays& graph, const infer::RignetModels& models);

}  // namespace osteon::pipelines
