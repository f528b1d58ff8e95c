// SPDX-License-Identifier: Apache-2.0
#include "osteon/rig/skin_weights.h"

#include <cmath>

#include "support/expect.h"

namespace osteon {
namespace {

using testing::HasSubstr;
constexpr JointId j0{0}, j1{1}, j2{2};

TEST(SkinWeights, append_merges_sorts_limits_and_normalises) {
  SkinWeights w;
  EXPECT_TRUE(w.append(std::vector<Influence>{{j0, 0.1f}, {j1, 0.25f}, {j0, 0.1f}, {j2, 0.05f}, {j2, -1.0f}, {j1, NAN}}, 2));
  ASSERT_EQ(w[VertexId{0}].size(), 2u);
  EXPECT_EQ(w[VertexId{0}][0].joint, j1);
  EXPECT_FLOAT_EQ(w[VertexId{0}][0].weight, 0.25f / 0.45f);
  EXPECT_FLOAT_EQ(w[VertexId{0}][1].weight, 0.2f / 0.45f);
  validate(w, 1, 3);
}

TEST(SkinWeights, equal_weights_keep_joint_order_whatever_the_input_order) {
  SkinWeights a, b;
  a.append(std::vector<Influence>{{j2, 0.5f}, {j0, 0.5f}});
  b.append(std::vector<Influence>{{j0, 0.5f}, {j2, 0.5f}});
  EXPECT_EQ(a, b);
  EXPECT_EQ(a[VertexId{0}][0].joint, j0);
}

TEST(SkinWeights, validate_finds_holes_and_unknown_joints) {
  SkinWeights w;
  w.append(std::vector<Influence>{{j2, 1.0f}});
  EXPECT_THAT(test::error_of([&] { validate(w, 1, 2); }), HasSubstr("vertex 0 is bound to joint 2"));
  EXPECT_FALSE(w.append({}));
  EXPECT_THAT(test::error_of([&] { validate(w, 2, 3); }), HasSubstr("vertex 1 has no skin weight"));
  EXPECT_THAT(test::error_of([&] { validate(w, 5, 3); }), HasSubstr("2 vertices, but the mesh has 5"));
}

}  // namespace
}  // namespace osteon
