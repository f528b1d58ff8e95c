// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/pack.h"

#include "capsule_character.h"
#include "osteon/base/safetensors.h"
#include "support/expect.h"

namespace osteon::dataset {
namespace {

std::vector<PreparedCharacter> two_characters() {
  Rig bent = test::capsule_character();
  for (Vec3f& p : bent.mesh.positions) p.x() += 0.1f * p.y() * p.y();
  return {prepare(test::capsule_character(), {"straight", "g", "other"}), prepare(bent, {"bent", "g", "fish"})};
}

float weight_of(const PreparedCharacter& c, VertexId v, JointId joint) {
  for (const Influence& i : c.weights[v])
    if (i.joint == joint) return i.weight;
  return 0.0f;
}

TEST(Pack, gives_back_what_was_saved) {
  const test::TemporaryFolder folder;
  const auto saved = two_characters();
  save_characters(folder / "x.safetensors", saved);
  const auto loaded = load_characters(folder / "x.safetensors");
  ASSERT_EQ(loaded.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const PreparedCharacter &a = saved[i], &b = loaded[i];
    EXPECT_EQ(a.info.id, b.info.id);
    EXPECT_EQ(a.info.category, b.info.category);
    EXPECT_EQ(a.mesh.positions, b.mesh.positions);
    EXPECT_EQ(a.mesh.faces, b.mesh.faces);
    EXPECT_EQ(a.one_ring, b.one_ring);
    EXPECT_EQ(a.balls.members, b.balls.members);
    EXPECT_EQ(a.voxels.voxels, b.voxels.voxels);
    EXPECT_EQ(a.skeleton.names, b.skeleton.names);
    EXPECT_EQ(a.skeleton.parents, b.skeleton.parents);
    EXPECT_EQ(a.skeleton.rest_positions, b.skeleton.rest_positions);
    EXPECT_EQ(a.attention, b.attention);
    EXPECT_EQ(a.tolerances, b.tolerances);
    EXPECT_EQ(a.nearest_bones, b.nearest_bones);
    EXPECT_EQ(a.normalization.scale, b.normalization.scale);
  }
}

TEST(Pack, rounds_weights_and_distances_as_little_as_their_types_allow) {
  const test::TemporaryFolder folder;
  const auto saved = two_characters();
  save_characters(folder / "x.safetensors", saved);
  const auto loaded = load_characters(folder / "x.safetensors");
  for (VertexId v : saved[0].mesh.positions.ids())
    for (JointId j : saved[0].skeleton.names.ids()) EXPECT_NEAR(weight_of(saved[0], v, j), weight_of(loaded[0], v, j), 3e-5f);
  EXPECT_TRUE(saved[0].nearest_distances.isApprox(loaded[0].nearest_distances, 5e-4f));
}

TEST(Pack, keeps_metadata) {
  const test::TemporaryFolder folder;
  save_characters(folder / "x.safetensors", two_characters(), {{"split", "val"}});
  EXPECT_EQ(load_safetensors(folder / "x.safetensors").metadata.at("split"), "val");
}

TEST(Pack, names_what_is_missing_or_does_not_fit) {
  const test::TemporaryFolder folder;
  save_characters(folder / "x.safetensors", two_characters());
  const Safetensors good = load_safetensors(folder / "x.safetensors");
  const auto error_without = [&](const std::string& name) {
    Safetensors broken = good;
    broken.arrays.erase(name);
    save_safetensors(folder / "y.safetensors", broken);
    return test::error_of([&] { load_characters(folder / "y.safetensors"); });
  };
  for (const auto& [name, array] : good.arrays) EXPECT_THAT(error_without(name), testing::HasSubstr(name));
  Safetensors broken = good;
  broken.arrays["bent/attention"] = Array::of<std::uint8_t>(std::vector<std::uint8_t>{1}, {1});
  save_safetensors(folder / "y.safetensors", broken);
  EXPECT_THAT(test::error_of([&] { load_characters(folder / "y.safetensors"); }),
              testing::HasSubstr("bent: attention or tolerances do not fit"));
  save_safetensors(folder / "z.safetensors", {});
  EXPECT_THAT(test::error_of([&] { load_characters(folder / "z.safetensors"); }), testing::HasSubstr("holds no prepared characters"));
}

}  // namespace
}  // namespace osteon::dataset
