// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/weight_cleanup.h"

#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::skin {
namespace {

Matrix random_rows(std::size_t rows, std::size_t columns, std::uint64_t seed) {
  Random random(seed);
  Matrix m(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = random.uniform();
  return m;
}

TEST(WeightCleanup, smoothing_keeps_constants_and_row_sums) {
  const TriangleMesh mesh = shapes::icosphere(2);
  const auto ring = geometry::one_ring(mesh);
  Matrix weights = random_rows(mesh.positions.size(), 5, 1);
  prune_rows(weights, 0.0f, 5);
  const Matrix smooth = smooth_rows(weights, ring);
  EXPECT_LT((smooth.rowwise().sum().array() - 1.0f).abs().maxCoeff(), 1e-5f);
  const Matrix constant = Matrix::Constant(weights.rows(), 3, 0.25f);
  EXPECT_LT((smooth_rows(constant, ring) - constant).cwiseAbs().maxCoeff(), 1e-6f);
}

TEST(WeightCleanup, smoothing_counts_the_own_row_so_that_lone_vertices_keep_theirs) {
  TriangleMesh mesh;
  for (float x : {0.0f, 1.0f, 2.0f, 9.0f}) mesh.positions.push_back(Vec3f(x, x * x, 0.0f));
  mesh.faces.push_back({VertexId{0}, VertexId{1}, VertexId{2}});  // vertex 3 has no face
  Matrix weights = Matrix::Zero(4, 2);
  weights.col(0) << 3, 0, 0, 1;
  weights.col(1) << 0, 3, 3, 0;
  const Matrix smooth = smooth_rows(weights, geometry::one_ring(mesh));
  for (int v = 0; v < 3; ++v) {
    EXPECT_FLOAT_EQ(smooth(v, 0), 1.0f);
    EXPECT_FLOAT_EQ(smooth(v, 1), 2.0f);
  }
  EXPECT_EQ(smooth.row(3), weights.row(3));
}

TEST(WeightCleanup, pruning_drops_what_is_small_beside_the_largest) {
  Matrix weights(3, 4);
  weights << 0.5f, 0.2f, 0.2f, 0.1f,  //
      0.0f, 0.0f, 0.0f, 0.0f,         //
      NAN, 0.6f, -0.4f, 0.2f;
  prune_rows(weights, 0.35f, 4);
  EXPECT_NEAR(weights(0, 0), 5.0f / 9.0f, 1e-6f);
  EXPECT_NEAR(weights(0, 1), 2.0f / 9.0f, 1e-6f);
  EXPECT_EQ(weights(0, 3), 0.0f);
  EXPECT_EQ(weights.row(1).sum(), 0.0f);
  EXPECT_EQ(weights(2, 0), 0.0f);
  EXPECT_EQ(weights(2, 1), 1.0f);  // 0.2 < 0.35 * 0.6
  EXPECT_EQ(weights(2, 2), 0.0f);
}

TEST(WeightCleanup, the_largest_few_stay_and_ties_go_to_the_first_column) {
  Matrix weights(1, 5);
  weights << 0.1f, 0.3f, 0.2f, 0.2f, 0.2f;
  prune_rows(weights, 0.0f, 3);
  EXPECT_EQ(weights(0, 0), 0.0f);
  EXPECT_EQ(weights(0, 4), 0.0f);
  EXPECT_NEAR(weights(0, 1), 0.3f / 0.7f, 1e-6f);
  EXPECT_EQ(weights(0, 2), weights(0, 3));
  EXPECT_GT(weights(0, 2), 0.0f);
}

TEST(WeightCleanup, holes_take_the_weights_of_the_nearest_vertex_along_edges) {
  // A strip of vertices 0..5 and, apart from it, a small box without weights.
  const TriangleMesh mesh = shapes::merged(
      shapes::sheet(5, 1), shapes::transformed(shapes::box({0.1f, 0.1f, 0.1f}), Transform(Eigen::Translation3f(1.3f, 0.5f, 0))));
  Matrix weights = Matrix::Zero(static_cast<Eigen::Index>(mesh.positions.size()), 2);
  weights(0, 0) = weights(6, 0) = 1.0f;   // the left end
  weights(5, 1) = weights(11, 1) = 1.0f;  // the right end
  EXPECT_EQ(fill_empty_rows(weights, mesh.positions, geometry::one_ring(mesh)), 8u + 8u);
  for (int v : {0, 1, 6, 7}) EXPECT_EQ(weights(v, 0), 1.0f);
  for (int v : {4, 5, 10, 11}) EXPECT_EQ(weights(v, 1), 1.0f);
  for (int v = 12; v < 20; ++v) EXPECT_EQ(weights(v, 1), 1.0f);
  EXPECT_EQ(weights.sum(), static_cast<float>(weights.rows()));
}

TEST(WeightCleanup, without_any_weight_nothing_is_filled) {
  const TriangleMesh mesh = shapes::icosphere(0);
  Matrix weights = Matrix::Zero(12, 2);
  EXPECT_EQ(fill_empty_rows(weights, mesh.positions, geometry::one_ring(mesh)), 0u);
  EXPECT_EQ(weights.sum(), 0.0f);
}

TEST(WeightCleanup, an_original_vertex_blends_the_corners_of_the_face_it_lies_on) {
  Matrix weights(3, 3);
  weights << 1, 0, 0,  //
      0, 1, 0,         //
      0.5f, 0, 0.5f;
  const VertexId a{0}, b{1}, c{2};
  const PerVertex<geometry::SurfacePoint> places{{{a, b, c}, {1, 0, 0}}, {{a, b, c}, {0, 0.25f, 0.75f}}, {{a, b, c}, {0.2f, 0.5f, 0.3f}}};
  const SkinWeights out = weights_on_original(weights, places, 2);
  validate(out, 3, 3);
  EXPECT_EQ(out[VertexId{0}][0], (Influence{JointId{0}, 1.0f}));
  ASSERT_EQ(out[VertexId{1}].size(), 2u);  // 0.375, 0.25, 0.375: the tie keeps joint 0 and 2, joint 1 goes
  EXPECT_EQ(out[VertexId{1}][0], (Influence{JointId{0}, 0.5f}));
  EXPECT_EQ(out[VertexId{1}][1], (Influence{JointId{2}, 0.5f}));
  EXPECT_NEAR(out[VertexId{2}][0].weight, 0.5f / 0.85f, 1e-6f);
}

// A sheet of so many columns, its left half bound to joint 0, its right half to joint 1.
struct HalvedSheet {
  geometry::CleanMesh clean;
  SkinWeights weights;
  explicit HalvedSheet(int columns) : clean(geometry::clean(shapes::sheet(columns, columns))) {
    const TriangleMesh sheet = shapes::sheet(columns, columns);
    for (const Vec3f& p : sheet.positions) weights.append({{{p.x() < 0.5f ? JointId{0} : JointId{1}, 1.0f}}});
  }
};

float weight_of(std::span<const Influence> row, JointId joint) {
  const auto found = std::ranges::find(row, joint, &Influence::joint);
  return found == row.end() ? 0.0f : found->weight;
}

TEST(WeightCleanup, coarse_meshes_are_even_enough) {
  const HalvedSheet sheet(100);
  EXPECT_EQ(evened(sheet.weights, sheet.clean, 4), sheet.weights);
}

TEST(WeightCleanup, on_a_fine_mesh_a_step_becomes_a_ramp_and_nothing_else_changes) {
  constexpr int columns = 300;
  const HalvedSheet sheet(columns);
  const TriangleMesh mesh = shapes::sheet(columns, columns);
  const SkinWeights even = evened(sheet.weights, sheet.clean, 4);
  validate(even, mesh.positions.size(), 2);
  float largest_step = 0.0f;
  for (int c = 0; c < columns; ++c) {  // along the middle row, a vertex after the other
    const auto v = static_cast<std::uint32_t>((columns / 2) * (columns + 1) + c);
    const Vec3f &here = mesh.positions[VertexId{v}], &next = mesh.positions[VertexId{v + 1}];
    ASSERT_GT(next.x(), here.x());
    const float step = weight_of(even[VertexId{v + 1}], JointId{1}) - weight_of(even[VertexId{v}], JointId{1});
    EXPECT_GE(step, -1e-6f);
    largest_step = std::max(largest_step, step);
    if (std::abs(here.x() - 0.5f) > 8.5f / columns) EXPECT_EQ(even[VertexId{v}][0], sheet.weights[VertexId{v}][0]);
  }
  EXPECT_LT(largest_step, 0.3f);  // 1 before
  EXPECT_GT(largest_step, 0.05f);
}

TEST(WeightCleanup, evened_weights_keep_to_the_largest_few) {
  const TriangleMesh mesh = shapes::icosphere(7, 0.5f);
  SkinWeights weights;
  Random random(4);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    std::vector<Influence> row;
    for (int k = 0; k < 3; ++k)
      row.push_back({static_cast<JointId>(static_cast<std::uint16_t>(random.below(9))), random.uniform(0.1f, 1.0f)});
    weights.append(row);
  }
  const SkinWeights even = evened(weights, geometry::clean(mesh), 3);
  validate(even, mesh.positions.size(), 9);
  EXPECT_EQ(even.max_influences(), 3u);
  EXPECT_NE(even, weights);
}

}  // namespace
}  // namespace osteon::skin
