// SPDX-License-Identifier: Apache-2.0
#include "osteon/program.h"

#include "osteon/base/safetensors.h"
#include "osteon/dataset/manifest.h"
#include "osteon/dataset/pack.h"
#include "osteon/io/load.h"
#include "osteon/io/motion.h"

namespace osteon {
namespace {

using test::osteon;
using testing::HasSubstr;

void write(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

// Characters of the generator in `characters`, and in `motions` one clip of somebody else: standing, and both arms up.
void write_corpus(const test::TemporaryFolder& folder) {
  std::filesystem::create_directories(folder / "characters");
  std::filesystem::create_directories(folder / "motions/biped");
  ASSERT_EQ(osteon(folder, "synth biped --seed 3 --cells 64 -o characters/biped.glb").code, 0);
  ASSERT_EQ(osteon(folder, "synth fish --seed 3 --cells 64 -o characters/fish.glb").code, 0);
  std::string manifest;
  for (const char* id : {"biped", "fish"})
    manifest += fmt::format(
        "{{\"id\": \"{0}\", \"file\": \"{0}.glb\", \"split\": \"train\", \"group\": \"g\", \"category\": \"c\", \"licence\": \"CC0-1.0\", "
        "\"author\": \"a\", \"source_repo\": \"s\"}}\n",
        id);
  write(folder / "characters/manifest.jsonl", manifest);
  write(folder / "motions/manifest.jsonl",
        "{\"file\": \"biped/up.bvh\", \"kind\": \"bvh\", \"rig\": \"someone\", \"licence\": \"MIT\", \"author\": \"b\", \"source\": "
        "\"t\"}\n");
  std::string joints = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n", closing = "}\n", map, angles;
  const auto open = [&](const std::string& name, const char* offset) {
    joints += "JOINT " + name + "\n{\nOFFSET " + offset + "\nCHANNELS 3 Zrotation Xrotation Yrotation\n";
  };
  for (const std::string side : {"Left", "Right"}) {
    const bool left = side == "Left";
    open(side + "Arm", left ? "0.2 0.5 0" : "-0.2 0.5 0");
    open(side + "ForeArm", left ? "0.3 0 0" : "-0.3 0 0");
    open(side + "Hand", left ? "0.3 0 0" : "-0.3 0 0");
    joints += "}\n}\n}\n";
    open(side + "UpLeg", left ? "0.1 0 0" : "-0.1 0 0");
    open(side + "Leg", "0 -0.4 0");
    open(side + "Foot", "0 -0.4 0");
    joints += "}\n}\n}\n";
    angles += left ? " 80 0 0" : " -80 0 0";
    for (int i = 0; i < 15; ++i) angles += " 0";
    for (const char* joint : {"Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot"})
      map += fmt::format(", \"{0}{1}\": \"{0}{1}\"", side, joint);
  }
  write(folder / "motions/biped/up.bvh", joints + closing + "MOTION\nFrames: 1\nFrame Time: 0.033\n0 0 0" + angles + "\n");
  write(folder / "motions/biped/joint_map.json", "{\"rigs\": {\"someone\": {\"map\": {\"Hips\": \"Hips\", \"Neck\": null" + map + "}}}}");
}

TEST(DatasetPrepare, gives_bipeds_poses_of_clips_and_others_none_and_names_where_clips_are_from) {
  const test::TemporaryFolder folder;
  write_corpus(folder);
  const auto run = osteon(folder, "dataset prepare --data characters --motions motions -o train.safetensors");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto characters = dataset::load_characters(folder / "train.safetensors");
  ASSERT_EQ(characters.size(), 2u);
  EXPECT_EQ(characters[0].poses.size(), 1u);
  EXPECT_TRUE(characters[1].poses.empty()) << "a fish";
  const Skeleton& skeleton = characters[0].skeleton;
  for (JointId j : skeleton.names.ids())
    if (skeleton.names[j].ends_with("Hand")) {
      const auto elbow = *skeleton.parents[j];
      EXPECT_GT(characters[0].poses[0].joints[j].y(), characters[0].poses[0].joints[elbow].y() + 0.02f) << "arms are up";
    }
  EXPECT_THAT(load_safetensors(folder / "train.safetensors").metadata.at("sources"), HasSubstr("\"clips\":1"));
}

TEST(DatasetPrepare, clips_of_characters_that_are_held_out_are_not_used) {
  const test::TemporaryFolder folder;
  write_corpus(folder);
  std::string manifest = test::content(folder / "characters/manifest.jsonl");
  manifest +=
      "{\"id\": \"someone\", \"file\": \"none.glb\", \"split\": \"test\", \"group\": \"h\", \"category\": \"c\", \"licence\": \"\", "
      "\"author\": \"\", \"source_repo\": \"\"}\n";
  write(folder / "characters/manifest.jsonl", manifest);
  ASSERT_EQ(osteon(folder, "dataset prepare --data characters --motions motions -o train.safetensors").code, 0);
  for (const auto& character : dataset::load_characters(folder / "train.safetensors")) EXPECT_TRUE(character.poses.empty());
}

TEST(DatasetPrepare, broken_clips_and_joint_maps_are_named) {
  const test::TemporaryFolder folder;
  write_corpus(folder);
  const auto error = [&] { return osteon(folder, "dataset prepare --data characters --motions motions -o train.safetensors").err; };
  write(folder / "motions/biped/joint_map.json", "{\"rigs\": {\"someone\": {\"map\": {\"Hips\": \"Pelvis\"}}}}");
  EXPECT_THAT(error(), HasSubstr("up.bvh: has no joint 'Pelvis', expected by the joint map as Hips"));
  write(folder / "motions/biped/joint_map.json", "{\"rigs\": {}}");
  EXPECT_THAT(error(), HasSubstr("up.bvh: its rig 'someone' is not in the joint map"));
}

// The corpus' own clips: bound as the characters are. Every eighth is looked at.
TEST(Motions, of_characters_have_their_joints_where_the_characters_have_them_at_rest) {
  const std::filesystem::path clips = OSTEON_DATA_FOLDER "/motions/creatures";
  if (!std::filesystem::exists(clips)) GTEST_SKIP() << "no clips in " << clips;
  std::size_t number = 0;
  for (const auto& entry : dataset::read_manifest(OSTEON_DATA_FOLDER, "train")) {
    const auto file = clips / (entry.info.id + ".glb");
    if (!std::filesystem::exists(file) || number++ % 8 != 0) continue;
    const io::Asset asset = io::load(entry.file);
    const std::string bytes = test::content(file);
    const Motion motion = io::read_motion(file, {bytes.begin(), bytes.end()}, 1.0);
    const float size = bounds(asset.mesh).sizes().maxCoeff();
    for (JointId j : asset.skeleton->names.ids()) {
      const auto found = std::ranges::find(motion.names, asset.skeleton->names[j]);
      ASSERT_NE(found, motion.names.end()) << entry.info.id << ": " << asset.skeleton->names[j];
      EXPECT_VEC3_NEAR(motion.rest[static_cast<std::size_t>(found - motion.names.begin())].translation(), asset.skeleton->rest_positions[j],
                       1e-3f * size)
          << entry.info.id;
    }
  }
}

}  // namespace
}  // namespace osteon
