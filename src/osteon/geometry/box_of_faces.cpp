// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/box_of_faces.h"

namespace osteon::geometry {

Eigen::AlignedBox3f box_of_faces(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Triangle& face : mesh.faces)
    for (VertexId v : face) box.extend(mesh.positions[v]);
  return box;
}

}  // namespace osteon::geometry
