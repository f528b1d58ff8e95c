// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/holdout.h"

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::dataset {
namespace {

// Capsules of another length each: all different shapes.
PreparedCharacter capsule(float length, const std::string& group) {
  PreparedCharacter c;
  c.info = {fmt::format("capsule {} of {}", length, group), group, "other"};
  c.mesh = shapes::capsule(0.2f, length, 12, 6);
  return c;
}

std::vector<PreparedCharacter> different(std::size_t count) {
  std::vector<PreparedCharacter> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(capsule(0.2f * std::pow(1.5f, static_cast<float>(i)), std::to_string(i)));
  return out;
}

bool holds(const std::vector<std::size_t>& indices, std::size_t i) { return std::ranges::find(indices, i) != indices.end(); }

TEST(Holdout, takes_the_share_and_leaves_the_others) {
  const Holdout split = hold_out(different(8), 0.25, 3);
  EXPECT_EQ(split.validation.size(), 2u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NE(holds(split.train, i), holds(split.validation, i));
}

TEST(Holdout, takes_one_at_least) { EXPECT_EQ(hold_out(different(3), 0.01, 1).validation.size(), 1u); }

TEST(Holdout, leaves_one_to_learn_from) {
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    EXPECT_EQ(hold_out(different(2), 0.9, seed).train.size(), 1u);
    EXPECT_EQ(hold_out(different(3), 0.9, seed).train.size(), 1u);
  }
}

TEST(Holdout, is_the_same_for_the_same_seed_and_another_for_another) {
  const auto characters = different(8);
  EXPECT_EQ(hold_out(characters, 0.25, 3).validation, hold_out(characters, 0.25, 3).validation);
  bool differs = false;
  for (std::uint64_t seed = 4; seed < 12; ++seed)
    differs |= hold_out(characters, 0.25, seed).validation != hold_out(characters, 0.25, 3).validation;
  EXPECT_TRUE(differs);
}

TEST(Holdout, keeps_groups_and_copies_on_one_side) {
  auto characters = different(6);
  characters[4].info.group = characters[0].info.group;
  characters.push_back(characters[2]);  // a copy ...
  characters.back().info.group = "copy";
  for (Vec3f& p : characters.back().mesh.positions) p *= 3.0f;  // ... of another size
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    const Holdout split = hold_out(characters, 0.3, seed);
    EXPECT_EQ(holds(split.train, 0), holds(split.train, 4));
    EXPECT_EQ(holds(split.train, 2), holds(split.train, 6));
  }
}

TEST(Holdout, takes_the_smallest_group_where_all_are_larger_than_wanted) {
  auto characters = different(7);
  for (std::size_t i = 0; i < 7; ++i) characters[i].info.group = i < 4 ? "four" : "three";
  EXPECT_EQ(hold_out(characters, 0.15, 1).validation, (std::vector<std::size_t>{4, 5, 6}));
}

TEST(Holdout, says_why_one_kind_of_character_is_not_enough) {
  auto characters = different(3);
  for (auto& c : characters) c.info.group = "one";
  EXPECT_THAT(test::error_of([&] { hold_out(characters, 0.15, 1); }), testing::HasSubstr("3 characters, all of one group or copies"));
}

}  // namespace
}  // namespace osteon::dataset
