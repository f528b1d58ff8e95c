// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/bind_features.h"

#include <gtest/gtest.h>

#include <cmath>

#include "osteon/base/random.h"
#include "osteon/nets/graph.h"

namespace osteon::geometry {
namespace {

static_assert(kBindFeatures == nets::bind_features);

// Joint 0 at the origin, 1 above it, 2 and 3 to the sides of 1: bones 0-1, 1-2, 1-3 and the leaves at 2 and 3.
const BoneList kBones{{{{0, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {1, 1, 0}}, {{0, 1, 0}, {-1, 1, 0}}, {{1, 1, 0}, {1, 1, 0}}, {{-1, 1, 0}, {-1, 1, 0}}},
                      {0, 1, 1, 2, 3},
                      {1, 2, 3, -1, -1}};

std::span<const float> row(const BindInputs& in, int i) { return std::span(in.features).subspan(static_cast<std::size_t>(i) * kBindFeatures, kBindFeatures); }

TEST(BindInputs, have_a_row_for_each_bone_that_there_is) {
  const IndexMatrix nearest = (IndexMatrix(2, 3) << 0, 1, -1, 2, -1, -1).finished();
  const BindInputs in = bind_inputs(std::vector<Vec3f>{{0.1f, 0.5f, 0}, {-0.5f, 1.2f, 0}}, std::vector<Vec3f>{{1, 0, 0}, {0, 1, 0}}, kBones,
                                    nearest, (Matrix(2, 3) << 0.1f, 0.6f, 0, 0.2f, 0, 0).finished());
  EXPECT_EQ(in.offsets, (std::vector<std::int32_t>{0, 2, 3}));
  EXPECT_EQ(in.features.size(), 3u * kBindFeatures);
}

TEST(BindInputs, say_how_the_bone_lies_to_the_vertex) {
  const IndexMatrix nearest = (IndexMatrix(1, 3) << 0, 1, 3).finished();
  const BindInputs in = bind_inputs(std::vector<Vec3f>{{0.1f, 0.5f, 0}}, std::vector<Vec3f>{{1, 0, 0}}, kBones, nearest,
                                    (Matrix(1, 3) << 0.1f, 0.6f, 1.4f).finished());
  const auto own = row(in, 0), child = row(in, 1), leaf = row(in, 2);
  EXPECT_FLOAT_EQ(own[0], proximity(0.1f));
  EXPECT_FLOAT_EQ(own[1], 0.0f);
  EXPECT_FLOAT_EQ(child[1], std::log(0.605f / 0.105f));
  EXPECT_FLOAT_EQ(own[4], 0.5f);   // half way along
  EXPECT_FLOAT_EQ(child[4], 0.1f);
  EXPECT_FLOAT_EQ(own[9], 1.0f);   // the normal points away from the bone
  EXPECT_FLOAT_EQ(child[10], 0.0f);
  EXPECT_EQ((std::array{own[6], child[6], leaf[6]}), (std::array{0.0f, 0.0f, 1.0f}));
  EXPECT_EQ((std::array{own[11], child[11], leaf[11]}), (std::array{1.0f, 0.0f, 0.0f}));
  EXPECT_EQ((std::array{own[12], child[12], leaf[12]}), (std::array{0.0f, 1.0f, 0.0f}));  // bone 1-2 starts where bone 0-1 ends
}

TEST(BindInputs, know_parents_and_siblings_of_the_nearest_bone) {
  const IndexMatrix nearest = (IndexMatrix(1, 3) << 3, 4, 1).finished();
  const BindInputs in = bind_inputs(std::vector<Vec3f>{{1, 1.1f, 0}}, std::vector<Vec3f>{{0, 1, 0}}, kBones, nearest,
                                    (Matrix(1, 3) << 0.1f, 0.2f, 0.3f).finished());
  EXPECT_EQ(row(in, 1)[14], 1.0f);  // the leaves at 2 and 3 hang on the same joint
  EXPECT_EQ(row(in, 2)[13], 1.0f);  // bone 1-2 is the parent of the leaf at 2
  EXPECT_EQ(row(in, 0)[14], 0.0f);
}

TEST(BindInputs, do_not_care_where_the_character_stands_or_faces) {
  Random random(1);
  std::vector<Vec3f> positions, normals, moved, turned_normals;
  const Eigen::Isometry3f motion = Eigen::Translation3f(3, -2, 1) * Eigen::AngleAxisf(1.1f, Vec3f(1, 2, 3).normalized());
  for (int i = 0; i < 20; ++i) {
    positions.push_back(Vec3f(random.uniform(), random.uniform(), random.uniform()));
    normals.push_back(Vec3f(random.normal(), random.normal(), random.normal()).normalized());
    moved.push_back(motion * positions.back());
    turned_normals.push_back(motion.linear() * normals.back());
  }
  BoneList bones = kBones;
  for (Segment& s : bones.segments) s = {motion * s.a, motion * s.b};
  const IndexMatrix nearest = IndexMatrix::Constant(20, 1, 2).eval();
  const Matrix distances = Matrix::Constant(20, 1, 0.3f);
  const BindInputs here = bind_inputs(positions, normals, kBones, nearest, distances), there = bind_inputs(moved, turned_normals, bones, nearest, distances);
  for (std::size_t i = 0; i < here.features.size(); ++i) EXPECT_NEAR(here.features[i], there.features[i], 1e-4f);
}

}  // namespace
}  // namespace osteon::geometry
