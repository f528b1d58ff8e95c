// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/motion.h"

#include "files.h"
#include "support/expect.h"

namespace osteon::io {
namespace {

using namespace osteon::io::test;
using gltf::Json;

constexpr double kAll = 30.0;  // poses a second: every frame of the clips below

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Motion read_bvh(const std::string& text, double per_second = kAll) { return read_motion("clip.bvh", bytes_of(text), per_second); }

// An arm along +x of two bones, each 1 long; the hand may be moved by its channels.
//   shoulder --- elbow --- hand
const std::string kArm = R"(HIERARCHY
ROOT shoulder
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT elbow
  {
    OFFSET 1 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT hand
    {
      OFFSET 1 0 0
      CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
      End Site
      {
        OFFSET 0.2 0 0
      }
    }
  }
}
MOTION
)";

TEST(Bvh, rest_is_the_offsets_and_zero_angles_are_the_rest_pose) {
  const Motion arm = read_bvh(kArm + "Frames: 1\nFrame Time: 0.0333333\n0 0 0 0 0 0  0 0 0  1 0 0 0 0 0\n");
  EXPECT_EQ(arm.names, (std::vector<std::string>{"shoulder", "elbow", "hand"}));
  ASSERT_EQ(arm.poses.size(), 1u);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_VEC3_NEAR(arm.rest[j].translation(), Vec3f(static_cast<float>(j), 0, 0), 1e-6f);
    EXPECT_TRUE(arm.poses[0][j].isApprox(arm.rest[j]));
  }
}

TEST(Bvh, angles_turn_in_the_order_of_the_channels_and_keep_the_lengths) {
  const Motion arm = read_bvh(kArm + "Frames: 1\nFrame Time: 0.0333333\n0 2 0 90 0 0  0 90 90  1 0 0 0 0 0\n");
  const auto& pose = arm.poses[0];
  EXPECT_VEC3_NEAR(pose[0].translation(), Vec3f(0, 2, 0), 1e-6f);
  EXPECT_VEC3_NEAR(pose[1].translation(), Vec3f(0, 3, 0), 1e-5f);
  // The elbow turns its child's way, x, by Rz(90) Rx(90) Ry(90): to -z, to y, and with the shoulder to -x.
  EXPECT_VEC3_NEAR(pose[2].translation(), Vec3f(-1, 3, 0), 1e-5f);
}

TEST(Bvh, position_channels_of_any_joint_stand_in_place_of_its_offset) {
  const Motion arm = read_bvh(kArm + "Frames: 1\nFrame Time: 0.0333333\n0 0 0 0 0 0  90 0 0  0 0.5 0 0 0 0\n");
  EXPECT_VEC3_NEAR(arm.poses[0][2].translation(), Vec3f(0.5f, 0, 0), 1e-5f);  // (1,0,0) + Rz(90) (0,0.5,0)
}

TEST(Bvh, is_thinned_to_so_many_poses_a_second) {
  std::string text = kArm + "Frames: 30\nFrame Time: 0.0333333\n";
  for (int i = 0; i < 30; ++i) text += std::to_string(i) + " 0 0 0 0 0  0 0 0  1 0 0 0 0 0\n";
  const Motion arm = read_bvh(text, 6.0);
  ASSERT_EQ(arm.poses.size(), 6u);
  EXPECT_VEC3_NEAR(arm.poses[1][0].translation(), Vec3f(5, 0, 0), 1e-6f);
}

TEST(Bvh, broken_ones_are_refused_with_file_line_found_and_expected) {
  const auto refused = [](const std::string& text) { return error_of([&] { read_bvh(text); }); };
  EXPECT_EQ(refused("solid cube"), "clip.bvh: line 1: found 'solid', expected HIERARCHY");
  EXPECT_THAT(refused("HIERARCHY\nROOT a\n{\n  OFFSET 0 x 0\n"), testing::HasSubstr("line 4: found 'x', expected three numbers of OFFSET"));
  EXPECT_THAT(refused("HIERARCHY\nROOT a\n{\n CHANNELS 1 Wrotation\n"),
              testing::HasSubstr("line 4: found 'Wrotation', expected a channel"));
  EXPECT_THAT(refused("HIERARCHY\nROOT a\n{\n CHANNELS 9\n"), testing::HasSubstr("line 4: found '9', expected 0 to 6 channels"));
  EXPECT_THAT(refused("HIERARCHY\nROOT a\n{\n"), testing::HasSubstr("found '', expected OFFSET, CHANNELS, JOINT"));
  EXPECT_THAT(refused(kArm + "Frames: 1000000000\nFrame Time: 0.03\n0 0\n"), testing::HasSubstr("1000000000 frames of 15 numbers"));
  EXPECT_THAT(refused(kArm + "Frames: 2\nFrame Time: 0.03\n0 0 0 0 0 0  0 0 0  1 0 0 0 0 0\n"),
              testing::HasSubstr("found '', expected a number for each channel"));
  EXPECT_THAT(refused(kArm + "Frames: 1\nFrame Time: 0\n"), testing::HasSubstr("frame time"));
  EXPECT_THAT(refused(kArm + "Frames: 0\nFrame Time: 0.03\n"), testing::HasSubstr("found no pose"));
}

// Two nodes; the lower is moved up from 0 s to 1 s, and the upper turned by 90 degrees about z.
gltf::Document animated(const char* interpolation) {
  gltf::Document document;
  document.json = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "hip", "translation": [0, 1, 0], "children": [1]}, {"name": "knee", "translation": [1, 0, 0]}]})");
  gltf::Writer writer(document);
  const std::vector<std::uint32_t> times{0, 1};
  const std::vector<float> ways{1, 0, 0, 1, 2, 0}, turns{0, 0, 0, 1, 0, 0, std::sqrt(0.5f), std::sqrt(0.5f)};
  const auto input = writer.scalars(times);
  const auto way = writer.vectors(ways, 3, gltf::Target::none), turn = writer.vectors(turns, 4, gltf::Target::none);
  document.json["animations"] = {{{"samplers",
                                   {{{"input", input}, {"output", way}, {"interpolation", interpolation}},
                                    {{"input", input}, {"output", turn}, {"interpolation", interpolation}}}},
                                  {"channels",
                                   {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
                                    {{"sampler", 1}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}}};
  return document;
}

Motion read_gltf(const gltf::Document& document, double per_second) {
  const TemporaryFolder folder;
  const auto path = write_document(folder / "clip.glb", document);
  return read_motion(path, read_file(path), per_second);
}

TEST(GltfAnimation, moves_the_nodes_between_key_frames_and_rest_is_their_own_transforms) {
  const Motion motion = read_gltf(animated("LINEAR"), 2.0);
  EXPECT_EQ(motion.names, (std::vector<std::string>{"hip", "knee"}));
  ASSERT_EQ(motion.poses.size(), 3u);
  EXPECT_VEC3_NEAR(motion.rest[1].translation(), Vec3f(1, 1, 0), 1e-6f);
  EXPECT_TRUE(motion.poses[0][1].isApprox(motion.rest[1]));
  const Eigen::AngleAxisf half(0.25f * static_cast<float>(M_PI), Vec3f::UnitZ());
  EXPECT_VEC3_NEAR(motion.poses[1][1].translation(), Vec3f(0, 1, 0) + half * Vec3f(1, 1, 0), 1e-5f);
  EXPECT_VEC3_NEAR(motion.poses[2][1].translation(), Vec3f(-2, 2, 0), 1e-5f);  // Rz(90) (1,2,0)
}

TEST(GltfAnimation, steps_stay_until_the_next_key_frame) {
  const Motion motion = read_gltf(animated("STEP"), 2.0);
  EXPECT_TRUE(motion.poses[1][1].isApprox(motion.rest[1]));
  EXPECT_VEC3_NEAR(motion.poses[2][1].translation(), Vec3f(-2, 2, 0), 1e-5f);
}

TEST(GltfAnimation, broken_ones_are_refused_by_name) {
  const auto refused = [](auto&& change) {
    gltf::Document document = animated("LINEAR");
    change(document.json);
    return error_of([&] { read_gltf(document, 2.0); });
  };
  EXPECT_THAT(
      refused([](Json& j) { j["animations"][0]["samplers"][1]["output"] = 1; }),
      testing::AllOf(testing::HasSubstr("clip.glb"), testing::HasSubstr("animations[0].samplers[1]"), testing::HasSubstr("expected")));
  EXPECT_THAT(refused([](Json& j) { j["animations"][0]["channels"][0]["target"]["node"] = 7; }),
              testing::HasSubstr("channels[0].target.node"));
  EXPECT_THAT(refused([](Json& j) { j.erase("animations"); }), testing::HasSubstr("found no pose"));
}

}  // namespace
}  // namespace osteon::io
