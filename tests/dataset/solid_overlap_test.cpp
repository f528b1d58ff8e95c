// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/solid_overlap.h"

#include <gtest/gtest.h>

#include "osteon/mesh/shapes.h"

namespace osteon::dataset {
namespace {

TEST(SolidOverlap, is_1_for_a_copy_of_another_size_at_another_place) {
  const TriangleMesh ball = shapes::icosphere(3, 0.5f);
  const Transform moved = Eigen::Translation3f(3, -1, 2) * Eigen::Scaling(40.0f);
  EXPECT_GT(overlap(solid_of(ball), solid_of(shapes::transformed(ball, moved))), 0.99);
}

// A ball in its bounding cube fills pi/6 of it; the ball's surface voxels make it a little more.
TEST(SolidOverlap, of_a_ball_and_its_cube_is_the_share_of_their_volumes) {
  const TriangleMesh ball = shapes::icosphere(4, 0.5f), cube = shapes::box(Vec3f(1, 1, 1));
  EXPECT_NEAR(overlap(solid_of(ball), solid_of(cube)), 3.14159265 / 6.0, 0.03);
}

}  // namespace
}  // namespace osteon::dataset
