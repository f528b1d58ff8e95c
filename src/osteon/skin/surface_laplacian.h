// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCore>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::skin {

using SparseMatrix = Eigen::SparseMatrix<double>;

// The cotangent Laplacian of a surface, (V,V), symmetric, positive semi-definite, rows sum to 0 (Pinkall and Polthier, "Computing Discrete
// Minimal Surfaces and Their Conjugates", 1993, eq. 6). Differs: weights of edges are kept above 0.01, as slivers and non-manifold edges
// would make them negative; so it is defined for any mesh.
SparseMatrix surface_laplacian(const TriangleMesh& mesh);

// A third of the area around every vertex, (V), never 0: at least a millionth of the mean.
Eigen::VectorXd vertex_areas(const TriangleMesh& mesh);

}  // namespace osteon::skin
