// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/islands.h"

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::skin {
namespace {

// An arm along x to a wrist at 1 with four fingers of two joints each, which end at 1.12.
Skeleton arm_with_hand() {
  Skeleton s;
  const JointId shoulder = s.add("shoulder", std::nullopt, {0, 0, 0});
  const JointId elbow = s.add("elbow", shoulder, {0.5f, 0, 0});
  const JointId wrist = s.add("wrist", elbow, {1, 0, 0});
  for (int k = 0; k < 4; ++k) {
    const float z = 0.03f * static_cast<float>(k - 1);
    const JointId first = s.add("finger_" + std::to_string(k), wrist, {1.06f, 0, z});
    s.add("tip_" + std::to_string(k), first, {1.12f, 0, z});
  }
  return s;
}

constexpr JointId kElbow{1}, kWrist{2}, kFinger{3}, kOtherFinger{5};

// A body of its own weights, and a small box beside it of which every vertex has `weights`.
struct BodyWithPart {
  TriangleMesh mesh;
  WeightRows rows;
  std::size_t first;  // vertex of the part

  BodyWithPart(const Vec3f& at, const Vec3f& size, const WeightRow& weights) {
    const TriangleMesh body = shapes::transformed(shapes::box({1.2f, 0.1f, 0.1f}), Transform(Eigen::Translation3f(0.6f, 0, 0)));
    first = body.positions.size();
    mesh = shapes::merged(body, shapes::transformed(shapes::box(size), Transform(Eigen::Translation3f(at))));
    rows = WeightRows(mesh.positions.size());
    for (const VertexId v : mesh.positions.ids())
      if (index(v) < first) {
        rows[v] = {{kElbow, 1.0f}};
      } else {
        rows[v] = weights;
      }
  }

  // The joint that all vertices of the part follow alone.
  std::optional<JointId> followed() const {
    const WeightRow& row = rows[static_cast<VertexId>(first)];
    for (std::size_t v = first; v < mesh.positions.size(); ++v)
      if (rows[static_cast<VertexId>(v)] != row) return std::nullopt;
    return row.size() == 1 ? std::optional(row.front().joint) : std::nullopt;
  }
};

const WeightRow kHeld{{kWrist, 0.35f}, {kFinger, 0.3f}, {kOtherFinger, 0.25f}, {kElbow, 0.1f}};

TEST(Islands, what_a_hand_holds_follows_its_palm) {
  BodyWithPart sword({1.05f, 0.3f, 0}, {0.02f, 0.4f, 0.02f}, kHeld);
  EXPECT_EQ(make_islands_rigid(sword.rows, sword.mesh, arm_with_hand()), 1u);
  EXPECT_EQ(sword.followed(), kWrist);
}

TEST(Islands, a_glove_in_which_the_fingers_lie_bends) {
  BodyWithPart glove({1.05f, 0, 0}, {0.2f, 0.06f, 0.2f}, kHeld);
  EXPECT_EQ(make_islands_rigid(glove.rows, glove.mesh, arm_with_hand()), 0u);
  EXPECT_EQ(glove.rows[static_cast<VertexId>(glove.first)], kHeld);
}

TEST(Islands, a_ring_follows_its_finger) {
  BodyWithPart ring({1.09f, 0, -0.03f}, {0.01f, 0.02f, 0.02f}, {{kFinger, 0.8f}, {kWrist, 0.2f}});
  EXPECT_EQ(make_islands_rigid(ring.rows, ring.mesh, arm_with_hand()), 1u);
  EXPECT_EQ(ring.followed(), kFinger);
}

TEST(Islands, legs_around_a_body_are_no_fingers) {
  Skeleton spider = arm_with_hand();
  for (Vec3f& p : spider.rest_positions)
    if (p.x() > 1.0f) p.z() *= 20.0f;
  BodyWithPart armour({1.05f, 0.3f, 0}, {0.02f, 0.4f, 0.02f}, kHeld);
  EXPECT_EQ(make_islands_rigid(armour.rows, armour.mesh, spider), 0u);
}

}  // namespace
}  // namespace osteon::skin
