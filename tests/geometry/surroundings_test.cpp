// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/surroundings.h"

#include <vector>

#include "geometry/mesh_makers.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

using shapes::merged;
using shapes::shifted;

// A body on two legs with a hat that floats over it: 1.9 high, 1 wide.
TriangleMesh hatted() {
  TriangleMesh mesh = shifted(shapes::box({1.0f, 0.8f, 0.4f}), {0, 1.2f, 0});
  for (float side : {-0.2f, 0.2f}) mesh = merged(mesh, shifted(shapes::box({0.2f, 0.8f, 0.3f}), {side, 0.4f, 0}));
  return merged(mesh, shifted(shapes::box({0.5f, 0.1f, 0.5f}), {0, 1.85f, 0}));
}

TriangleMesh plate(float width, float thickness, float top) {
  return shifted(shapes::box({width, thickness, width}), {0, top - thickness / 2, 0});
}

TriangleMesh speck(const Vec3f& at) { return shifted(shapes::icosphere(0, 0.01f), at); }

// `beside` comes after the character's vertices: whether all of it, and nothing of the character, is told apart.
testing::AssertionResult is_told_apart(const TriangleMesh& character, const TriangleMesh& beside) {
  const Surroundings found = surroundings(merged(character, beside));
  if (found.vertices != beside.positions.size()) return testing::AssertionFailure() << found.vertices << " vertices found";
  for (VertexId v : character.positions.ids())
    if (found.has[v]) return testing::AssertionFailure() << "vertex " << index(v) << " of the character";
  return testing::AssertionSuccess();
}

TEST(Surroundings, a_character_alone_has_none) {
  EXPECT_EQ(surroundings(hatted()).vertices, 0u);
  EXPECT_EQ(surroundings(shapes::sheet(3, 3)).vertices, 0u);
  TriangleMesh points;
  points.positions.raw() = {{0, 0, 0}, {9, 9, 9}};
  EXPECT_EQ(surroundings(points).vertices, 0u);
}

TEST(Surroundings, the_ground_is_told_apart_along_y_and_z) {
  for (const TriangleMesh& ground : {plate(2, 0.1f, 0.0f), plate(2, 0.1f, 0.05f), plate(500, 0.2f, 0.0f), plate(0.8f, 0.01f, -0.01f)}) {
    EXPECT_TRUE(is_told_apart(hatted(), ground));
    const Transform lies(Eigen::AngleAxisf(0.5f * std::numbers::pi_v<float>, Vec3f::UnitX()));
    EXPECT_TRUE(is_told_apart(shapes::transformed(hatted(), lies), shapes::transformed(ground, lies)));
  }
}

TEST(Surroundings, a_base_on_the_ground_goes_with_it) {
  EXPECT_TRUE(is_told_apart(hatted(), merged(plate(1, 0.1f, 0), plate(3, 0, -0.1f))));
}

TEST(Surroundings, shoes_and_what_is_as_wide_as_what_stands_on_it_stay) {
  TriangleMesh shod = hatted();
  for (float side : {-0.2f, 0.2f}) shod = merged(shod, shifted(shapes::box({0.3f, 0.1f, 0.5f}), {side, -0.05f, 0}));
  EXPECT_EQ(surroundings(shod).vertices, 0u);
  EXPECT_EQ(surroundings(merged(shapes::capsule(0.5f, 2.0f), plate(1.0f, 0.01f, -0.5f))).vertices, 0u);
  EXPECT_EQ(surroundings(merged(hatted(), plate(2, 0.5f, 0.0f))).vertices, 0u) << "too thick";
  EXPECT_EQ(surroundings(merged(hatted(), plate(2, 0.1f, 0.4f))).vertices, 0u) << "at the knees";
}

TEST(Surroundings, strays_are_told_apart_and_what_floats_near_is_not) {
  EXPECT_TRUE(is_told_apart(hatted(), speck({40, 1, 0})));
  EXPECT_TRUE(is_told_apart(hatted(), merged(speck({0, 1e6f, 0}), speck({0, 0, -3}))));
  EXPECT_EQ(surroundings(merged(hatted(), speck({1, 2, 0}))).vertices, 0u);
  EXPECT_EQ(surroundings(merged(hatted(), shifted(shapes::icosphere(2, 0.5f), {40, 1, 0}))).vertices, 0u) << "too large";
}

TEST(Surroundings, a_part_with_a_joint_far_away_is_no_stray) {
  const std::vector<Vec3f> joints = {{0, 1, 0}, {38, 1, 0}};
  EXPECT_EQ(surroundings(merged(hatted(), speck({40, 1, 0})), joints).vertices, 0u);
  EXPECT_EQ(surroundings(merged(hatted(), speck({400, 1, 0})), joints).vertices, speck({0, 0, 0}).positions.size());
}

TEST(Surroundings, the_only_body_that_there_is_is_none_however_small_and_far_from_the_joints) {
  const std::vector<Vec3f> joints = {{0, 1, 0}};
  for (const float size : {1.0f, 1e-10f, 1e-20f, 1e-30f}) {
    TriangleMesh mesh = hatted();
    for (Vec3f& p : mesh.positions) p *= size;
    EXPECT_EQ(surroundings(mesh, joints).vertices, 0u) << size;
  }
}

TEST(Surroundings, strays_do_not_hide_the_ground) { EXPECT_TRUE(is_told_apart(hatted(), merged(plate(5, 0.1f, 0), speck({0, -40, 0})))); }

TEST(Surroundings, what_is_left_is_the_character_in_its_order) {
  const TriangleMesh mesh = merged(merged(plate(4, 0.1f, 0), hatted()), speck({9, 9, 9}));
  const TriangleMesh left = without(mesh, surroundings(mesh).has);
  EXPECT_EQ(left.positions, hatted().positions);
  EXPECT_EQ(left.faces, hatted().faces);
}

TEST(Surroundings, depend_on_the_shape_only) {
  const TriangleMesh mesh = merged(merged(plate(4, 0.1f, 0), hatted()), speck({9, 9, 9}));
  EXPECT_EQ(surroundings(test::shuffled(mesh, 3)).vertices, surroundings(mesh).vertices);
  EXPECT_EQ(surroundings(test::unshared(merged(hatted(), plate(4, 0.1f, 0)))).vertices, 36u);
}

}  // namespace
}  // namespace osteon::geometry
