// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/pack.h"

#include "capsule_character.h"
#include "osteon/base/safetensors.h"
#include "osteon/dataset/articulate.h"
#include "osteon/dataset/batch.h"
#include "support/expect.h"

namespace osteon::dataset {
namespace {

std::vector<PreparedCharacter> two_characters() {
  Rig bent = test::capsule_character();
  for (Vec3f& p : bent.mesh.positions) p.x() += 0.1f * p.y() * p.y();
  orient_along_bones(bent.skeleton);
  return {prepare(test::capsule_character(), {"straight", "g", "other"}), prepare(bent, {"bent", "g", "fish"})};
}

constexpr float kRounding = 1.5e-5f;  // half a step of 1/65535 along each axis

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
    for (VertexId v : a.mesh.positions.ids()) EXPECT_VEC3_NEAR(a.mesh.positions[v], b.mesh.positions[v], kRounding);
    EXPECT_EQ(a.mesh.faces, b.mesh.faces);
    EXPECT_EQ(a.one_ring, b.one_ring);
    EXPECT_EQ(a.balls.members.size(), b.balls.members.size());
    EXPECT_EQ(a.voxels.voxels.size(), b.voxels.voxels.size());
    EXPECT_EQ(a.skeleton.names, b.skeleton.names);
    EXPECT_EQ(a.skeleton.parents, b.skeleton.parents);
    EXPECT_EQ(a.skeleton.rest_positions, b.skeleton.rest_positions);
    for (JointId j : a.skeleton.names.ids())
      EXPECT_LT(a.skeleton.rest_orientations[j].angularDistance(b.skeleton.rest_orientations[j]), 1e-3f);
    EXPECT_EQ(a.attention, b.attention);
    EXPECT_EQ(a.tolerances, b.tolerances);
    EXPECT_EQ(a.normalization.scale, b.normalization.scale);
  }
}

TEST(Pack, rounds_weights_as_little_as_their_type_allows_and_they_still_sum_to_one) {
  const test::TemporaryFolder folder;
  const auto saved = two_characters();
  save_characters(folder / "x.safetensors", saved);
  const auto loaded = load_characters(folder / "x.safetensors");
  for (VertexId v : saved[0].mesh.positions.ids()) {
    float sum = 0.0f;
    for (JointId j : saved[0].skeleton.names.ids()) {
      EXPECT_NEAR(weight_of(saved[0], v, j), weight_of(loaded[0], v, j), 3e-5f);
      sum += weight_of(loaded[0], v, j);
    }
    EXPECT_NEAR(sum, 1.0f, 1e-6f);
  }
}

// Positions move by less than a thousandth of a voxel: what is derived from them stays what it was, but where a way
// through the voxels is as long as another.
TEST(Pack, derives_after_loading_what_was_there_before_saving) {
  const test::TemporaryFolder folder;
  const auto saved = two_characters();
  save_characters(folder / "x.safetensors", saved);
  auto loaded = load_characters(folder / "x.safetensors");
  EXPECT_EQ(loaded[0].nearest_bones.rows(), 0);
  const auto examples = examples_of(std::move(loaded), Parts::bind);
  for (std::size_t i = 0; i < 2; ++i) {
    const PreparedCharacter &a = saved[i], &b = examples[i].character;
    ASSERT_EQ(a.nearest_distances.rows(), b.nearest_distances.rows());
    EXPECT_LT((a.nearest_distances - b.nearest_distances).array().abs().mean(), 1e-3f);  // a tenth of a voxel
    std::size_t moved = 0;
    for (std::size_t k = 0; k < a.voxels.voxels.size(); ++k) moved += a.voxels.voxels[k] != b.voxels.voxels[k] ? 1 : 0;
    EXPECT_LT(static_cast<double>(moved) / static_cast<double>(a.voxels.voxels.size()), 1e-3);
  }
}

TEST(Pack, gives_back_poses_to_the_precision_of_half_numbers_and_none_where_there_were_none) {
  const test::TemporaryFolder folder;
  auto saved = two_characters();
  Random random(1);
  for (int i = 0; i < 3; ++i) saved[1].poses.push_back(random_articulation(saved[1].skeleton, std::nullopt, {}, random));
  save_characters(folder / "x.safetensors", saved);
  const auto loaded = load_characters(folder / "x.safetensors");
  EXPECT_TRUE(loaded[0].poses.empty());
  ASSERT_EQ(loaded[1].poses.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    for (JointId j : saved[1].skeleton.names.ids()) {
      const Articulation &a = saved[1].poses[i], &b = loaded[1].poses[i];
      EXPECT_LT((a.linear[j] - b.linear[j]).cwiseAbs().maxCoeff(), 1e-3f);
      EXPECT_VEC3_NEAR(a.joints[j], b.joints[j], 1e-3f);
    }
}

TEST(Pack, a_saved_file_saved_again_stays_the_same) {
  const test::TemporaryFolder folder;
  save_characters(folder / "x.safetensors", two_characters());
  save_characters(folder / "y.safetensors", load_characters(folder / "x.safetensors"));
  const Safetensors x = load_safetensors(folder / "x.safetensors"), y = load_safetensors(folder / "y.safetensors");
  for (const auto& [name, array] : x.arrays) EXPECT_EQ(array.bytes, y.at(name).bytes) << name;
}

// Files of before: positions as floats, all numbers in 16 bits, and the nearest bones.
TEST(Pack, still_reads_files_of_before) {
  const test::TemporaryFolder folder;
  const auto saved = two_characters();
  save_characters(folder / "x.safetensors", saved);
  Safetensors file = load_safetensors(folder / "x.safetensors");
  const auto wide = [&](const std::string& name) {
    const auto small = file.at(name).values<std::uint8_t>();
    file.arrays[name] = Array::of<std::uint16_t>(std::vector<std::uint16_t>(small.begin(), small.end()), file.at(name).shape);
  };
  for (const PreparedCharacter& c : saved) {
    const std::string prefix = c.info.id + "/";
    std::vector<float> flat;
    for (const Vec3f& p : c.mesh.positions) flat.insert(flat.end(), p.begin(), p.end());
    file.arrays[prefix + "positions"] = Array::of<float>(flat, {static_cast<std::int64_t>(c.vertices()), 3});
    wide(prefix + "influences");
    wide(prefix + "influence_joints");
    const std::vector<std::int64_t> shape{c.nearest_bones.rows(), c.nearest_bones.cols()};
    file.arrays[prefix + "nearest_bones"] = Array::of<std::uint16_t>(
        std::vector<std::uint16_t>(c.nearest_bones.data(), c.nearest_bones.data() + c.nearest_bones.size()), shape);
    file.arrays[prefix + "nearest_distances"] =
        Array::half(std::span(c.nearest_distances.data(), static_cast<std::size_t>(c.nearest_distances.size())), shape);
  }
  save_safetensors(folder / "old.safetensors", file);
  const auto loaded = load_characters(folder / "old.safetensors");
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(saved[i].mesh.positions, loaded[i].mesh.positions);
    EXPECT_EQ(saved[i].nearest_bones, loaded[i].nearest_bones);
    EXPECT_TRUE(saved[i].nearest_distances.isApprox(loaded[i].nearest_distances, 5e-4f));
  }
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
  for (const auto& [name, array] : good.arrays)
    if (!name.ends_with("/orientations")) EXPECT_THAT(error_without(name), testing::HasSubstr(name));  // files of before hold none
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
