// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/super_skeleton.h"

#include <set>

#include "support/expect.h"

namespace osteon::skin {
namespace {

// A person of nine joints, in one of two naming conventions.
Skeleton person(bool by_suffix, float width = 1.0f) {
  const auto named = [&](const std::string& side, const std::string& part) {
    return by_suffix ? part + (side == "Left" ? ".L" : ".R") : side + part;
  };
  Skeleton s;
  const JointId hips = s.add(by_suffix ? "pelvis" : "Hips", std::nullopt, {0, 0.5f, 0});
  const JointId spine = s.add("Spine", hips, {0, 0.65f, 0});
  s.add("Head", spine, {0, 0.9f, 0});
  for (const auto& [side, x] : {std::pair("Left", 0.1f), std::pair("Right", -0.1f)}) {
    const JointId thigh = s.add(named(side, by_suffix ? "UpperLeg" : "UpLeg"), hips, {x * width, 0.5f, 0});
    s.add(named(side, by_suffix ? "LowerLeg" : "Leg"), thigh, {x * width, 0.25f, 0});
    s.add(named(side, by_suffix ? "UpperArm" : "Arm"), spine, {2 * x * width, 0.8f, 0});
  }
  return s;
}

SuperSkeleton learned() {
  const Skeleton a = person(false), b = person(false, 1.2f), c = person(false, 0.9f);
  return learn_super_skeleton(std::vector<NamedSkeleton>{{&a, "a"}, {&b, "b"}, {&c, "c"}});
}

TEST(SuperSkeleton, has_a_slot_for_each_part_and_side_where_it_usually_stands) {
  const SuperSkeleton super = learned();
  ASSERT_EQ(super.slots().size(), 9u);
  for (const Slot& slot : super.slots())
    if (slot.name == BoneName{"thigh", Side::left}) {
      EXPECT_VEC3_NEAR(slot.position, Vec3f(0.1f * (1.0f + 1.2f + 0.9f) / 3.0f, 0.5f, 0), 1e-5f);
    }
}

TEST(SuperSkeleton, another_naming_convention_falls_on_the_same_slots) {
  const SuperSkeleton super = learned();
  const SlotAssignment a = super.assign(person(false)), b = super.assign(person(true));
  EXPECT_EQ(a.slot, b.slot);
  for (const bool by_name : b.by_name) EXPECT_TRUE(by_name);
}

TEST(SuperSkeleton, places_decide_where_names_say_nothing) {
  const SuperSkeleton super = learned();
  const Skeleton known = person(false);
  Skeleton unknown = known;
  for (JointId j : unknown.names.ids()) unknown.names[j] = "Bone." + std::to_string(index(j));
  EXPECT_EQ(super.assign(unknown).slot, super.assign(known).slot);
  EXPECT_EQ(super.assign(known, false).slot, super.assign(known).slot);
}

TEST(SuperSkeleton, a_mirrored_skeleton_falls_on_the_slots_of_the_other_side) {
  const SuperSkeleton super = learned();
  Skeleton mirrored = person(false);
  for (JointId j : mirrored.names.ids()) {
    mirrored.rest_positions[j].x() = -mirrored.rest_positions[j].x();
    std::string& name = mirrored.names[j];
    if (name.starts_with("Left"))
      name.replace(0, 4, "Right");
    else if (name.starts_with("Right"))
      name.replace(0, 5, "Left");
  }
  const SlotAssignment here = super.assign(person(false)), there = super.assign(mirrored);
  for (JointId j : mirrored.names.ids()) {
    const Slot &a = super.slots()[here.slot[j]], &b = super.slots()[there.slot[j]];
    EXPECT_EQ(a.name.side, opposite(b.name.side));
    EXPECT_EQ(a.kind, b.kind);
  }
}

TEST(SuperSkeleton, no_two_joints_share_a_slot_while_there_are_enough) {
  std::vector<Slot> slots;
  for (int i = 0; i < 200; ++i) slots.push_back({{}, {0.0f, 0.005f * static_cast<float>(i), 0.0f}, 0});
  Skeleton chain;
  for (int i = 0; i < 163; ++i)
    chain.add("tentacle" + std::to_string(i), i == 0 ? std::nullopt : std::optional(static_cast<JointId>(i - 1)),
              {0.0f, 1.0f - 0.004f * static_cast<float>(i), 0.0f});
  const SlotAssignment many = SuperSkeleton(slots).assign(chain);
  EXPECT_EQ(std::set<std::size_t>(many.slot.begin(), many.slot.end()).size(), 163u);
  slots.resize(100);
  for (const std::size_t slot : SuperSkeleton(slots).assign(chain).slot) EXPECT_LT(slot, 100u);  // the rest with one above
}

TEST(SuperSkeleton, comes_back_from_its_text) {
  const SuperSkeleton super = learned(), back = SuperSkeleton::from_json(super.to_json());
  EXPECT_EQ(back.slots(), super.slots());
  EXPECT_THAT(test::error_of([] { SuperSkeleton::from_json("[[1]]"); }), testing::HasSubstr("super skeleton"));
  EXPECT_THAT(test::error_of([] { SuperSkeleton::from_json("[]"); }), testing::HasSubstr("no slots"));
}

}  // namespace
}  // namespace osteon::skin
