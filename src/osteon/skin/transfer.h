// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/rig/rig.h"
#include "osteon/skin/weight_rows.h"

namespace osteon::skin {

struct TransferOptions {
  float reach = 0.05f;       // of a vertex to the reference, in parts of the bounding box's diagonal
  float angle = 0.5235988f;  // between the normals, radians: 30 degrees; opposite normals count as equal
};

struct Transfer {
  WeightRows rows;            // sums 1
  std::size_t taken = 0;      // vertices that took the reference's weights as they are
  std::size_t inpainted = 0;  // the others
};

// Weights of another mesh that stands in the same place: Abdrashitov, Raichstat, Monsen, Hill. Robust Skin Weights Transfer via Weight
// Inpainting. SIGGRAPH Asia 2023 (technical communications). Vertices close to the reference, with the same normal, take the weights of the
// closest point (sec. 3.1); those of the others are the smoothest that continue them: least w^T (L + L M^-1 L) w (sec. 3.2). Pieces where
// nobody is close enough take the closest point whatever it is like. `joint_of` gives the joints of the result for those of the reference.
// Pre: validate(reference) holds; `mesh` has faces.
Transfer transferred_weights(const TriangleMesh& mesh, const Rig& reference, const PerJoint<JointId>& joint_of,
                             const TransferOptions& options = {});

}  // namespace osteon::skin
