// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/voxel_grid.h"

#include <cmath>
#include <numbers>

#include "geometry/tube.h"
#include "mesh_makers.h"
#include "osteon/base/parallel.h"
#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

double volume(const VoxelGrid& grid, Voxel kind) {
  return static_cast<double>(std::ranges::count(grid.voxels, kind)) * std::pow(static_cast<double>(grid.cell), 3.0);
}

Vec3f random_point_in_ball(Random& random) {
  while (true) {
    const Vec3f p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (p.norm() <= 1.0f) return p;
  }
}

TEST(VoxelGrid, has_the_resolution_along_the_longest_side_and_a_margin) {
  const VoxelGrid grid = voxelize(shapes::box({1, 2, 0.5f}), 88);
  EXPECT_EQ(grid.size.y(), 88 + 2);
  EXPECT_EQ(grid.size.x(), 44 + 2);
  EXPECT_EQ(grid.size.z(), 22 + 2);
  EXPECT_NEAR(grid.cell * 88, 2.0f, 3e-4f);
}

TEST(VoxelGrid, every_point_of_the_surface_lies_in_a_surface_voxel) {
  const TriangleMesh mesh = shapes::icosphere(2);
  const VoxelGrid grid = voxelize(mesh);
  Random random(5);
  for (const auto& [a, b, c] : mesh.faces)
    for (int i = 0; i < 50; ++i) {
      const float s = std::sqrt(random.uniform()), t = random.uniform();
      const Vec3f p = (1 - s) * mesh.positions[a] + s * (1 - t) * mesh.positions[b] + s * t * mesh.positions[c];
      EXPECT_EQ(grid.at(p), Voxel::Surface);
    }
}

TEST(VoxelGrid, surface_voxels_touch_the_surface) {
  const VoxelGrid grid = voxelize(shapes::icosphere(5), 40);
  for (int i = 0; i < grid.size.x(); ++i)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int k = 0; k < grid.size.z(); ++k)
        if (const Vec3f center = grid.center({i, j, k}); grid.at(center) == Voxel::Surface)
          EXPECT_NEAR(center.norm(), 1.0f, 0.5f * std::sqrt(3.0f) * grid.cell + 1e-3f);
}

TEST(VoxelGrid, volume_of_a_sphere_lies_between_interior_and_all) {
  const VoxelGrid grid = voxelize(shapes::icosphere(4), 88);
  const double interior = volume(grid, Voxel::Interior), surface = volume(grid, Voxel::Surface), ball = 4 * std::numbers::pi / 3;
  EXPECT_LT(interior, ball);
  EXPECT_GT(interior + surface, ball);
  EXPECT_NEAR(interior + 0.5 * surface, ball, 0.02 * ball);
}

TEST(VoxelGrid, knows_inside_from_outside_away_from_the_surface) {
  const VoxelGrid grid = voxelize(shapes::icosphere(4));
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Vec3f p = random_point_in_ball(random);
    EXPECT_TRUE(grid.inside(p));
    EXPECT_FALSE(grid.inside(p.normalized() * 1.05f));
  }
  EXPECT_FALSE(grid.inside({50, 0, 0}));
  EXPECT_FALSE(grid.inside({0, -1e30f, 0}));
}

TEST(VoxelGrid, inside_does_not_need_a_closed_mesh) {
  TriangleMesh mesh = test::tube({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, 0.3f);
  PerFace<Triangle> sides;  // without the two lids
  for (const Triangle& t : mesh.faces)
    if (index(t[0]) < 3 * 16) sides.push_back(t);
  mesh.faces = sides;
  const VoxelGrid grid = voxelize(mesh);
  for (float y : {0.1f, 1.0f, 1.9f}) EXPECT_EQ(grid.at({0.05f, y, 0.02f}), Voxel::Interior);
  for (float y : {-0.1f, 2.1f}) EXPECT_FALSE(grid.inside({0, y, 0}));
  EXPECT_FALSE(grid.inside({0.5f, 1, 0}));
}

TEST(VoxelGrid, overlapping_parts_stay_solid) {
  const VoxelGrid grid = voxelize(shapes::merged(shapes::icosphere(3), shapes::shifted(shapes::icosphere(3), {0.7f, 0, 0})));
  EXPECT_EQ(grid.at({0.35f, 0.02f, 0.01f}), Voxel::Interior);  // in both: parity would say outside
  EXPECT_EQ(grid.at({-0.5f, 0, 0}), Voxel::Interior);
}

TEST(VoxelGrid, the_gap_between_two_equal_boxes_is_outside) {
  for (const Vec3f& size : {Vec3f(0.2f, 1, 0.2f), Vec3f(0.4f, 0.4f, 0.4f), Vec3f(0.3f, 0.3f, 1)}) {
    const TriangleMesh box = shapes::box(size);
    const VoxelGrid grid = voxelize(shapes::merged(shapes::shifted(box, {-0.3f, 0, 0}), shapes::shifted(box, {0.3f, 0, 0})));
    EXPECT_EQ(grid.at(Vec3f::Zero()), Voxel::Outside) << size.transpose();
    EXPECT_EQ(grid.at({-0.3f, 0, 0}), Voxel::Interior) << size.transpose();
  }
}

TEST(VoxelGrid, pieces_that_face_inwards_are_solid_too) {
  const VoxelGrid grid = voxelize(test::flipped(shapes::icosphere(3)));
  EXPECT_EQ(grid.at({0.2f, 0.1f, 0}), Voxel::Interior);
  EXPECT_FALSE(grid.inside({0, 1.05f, 0}));
}

TEST(VoxelGrid, a_single_sheet_has_no_inside) {
  const VoxelGrid grid = voxelize(shapes::sheet(5, 5));
  EXPECT_EQ(std::ranges::count(grid.voxels, Voxel::Interior), 0);
  EXPECT_GT(std::ranges::count(grid.voxels, Voxel::Surface), 0);
}

TEST(VoxelGrid, does_not_depend_on_the_number_of_threads_or_the_order_of_faces) {
  TriangleMesh mesh = shapes::merged(shapes::icosphere(3), shapes::shifted(shapes::capsule(0.2f, 2.0f), {0.3f, 0, 0.1f}));
  const int before = threads();
  set_threads(1);
  const VoxelGrid one = voxelize(mesh);
  set_threads(3);
  std::ranges::reverse(mesh.faces.raw());
  const VoxelGrid three = voxelize(mesh);
  set_threads(before);
  EXPECT_EQ(one.voxels, three.voxels);
}

TEST(VoxelGrid, even_a_point_and_a_mesh_without_faces_have_a_grid) {
  TriangleMesh mesh;
  mesh.positions.push_back(Vec3f(1, 2, 3));
  EXPECT_FALSE(voxelize(mesh).inside({1, 2, 3}));
}

TEST(VoxelGrid, has_voxels_even_where_coordinates_are_coarser_than_they_are) {
  const VoxelGrid grid = voxelize(shapes::shifted(shapes::box({1, 1, 1}), {1e6f, 0, 0}), 256);
  EXPECT_GT(std::ranges::count(grid.voxels, Voxel::Interior), 0);
  EXPECT_TRUE(grid.inside({1e6f, 0, 0}));
}

TEST(BoneSamples, exclude_the_first_end_and_include_the_second) {
  const VoxelGrid grid = voxelize(shapes::box({1, 1, 1}));
  EXPECT_EQ(sample_count({{0, 0, 0}, {1, 0, 0}}), 100);
  EXPECT_EQ(samples_outside(grid, {{0, 0, 0}, {1, 0, 0}}, 0.25f), 2);  // at 0.25, 0.5 (in the skin), 0.75, 1
  EXPECT_FLOAT_EQ(inside_fraction(grid, {{0, 0, 0}, {1, 0, 0}}, 0.25f), 0.5f);
  EXPECT_EQ(samples_outside(grid, {{2, 0, 0}, {0, 0, 0}}, 1.0f), 1);  // at 1 and 0
}

TEST(BoneSamples, of_a_bone_without_length_are_its_end) {
  const VoxelGrid grid = voxelize(shapes::box({1, 1, 1}));
  EXPECT_EQ(inside_fraction(grid, {{0, 0, 0}, {0, 0, 0}}), 1.0f);
  EXPECT_EQ(inside_fraction(grid, {{3, 0, 0}, {3, 0, 0}}), 0.0f);
}

}  // namespace
}  // namespace osteon::geometry
