// SPDX-License-Identifier: Apache-2.0
// What bf16 may cost: joints within 0.1 % of the size and weights within 0.005 of those in f32, on average.
#include <cmath>
#include <filesystem>

#include "osteon/pipelines/rignet.h"
#include "osteon/synth/character.h"
#include "support/expect.h"

namespace osteon {
namespace {

struct Models {
  infer::RignetModels f32, bf16;
};

class Precision : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(OSTEON_MODELS_FOLDER "/rignet")) GTEST_SKIP() << "models/rignet is not there";
    if (!tensor::has_bf16()) GTEST_SKIP() << "this processor does not multiply bf16";
  }
  static const Models& models() {
    static const Models loaded{infer::RignetModels::load(OSTEON_MODELS_FOLDER "/rignet", tensor::Precision::f32),
                               infer::RignetModels::load(OSTEON_MODELS_FOLDER "/rignet", tensor::Precision::bf16)};
    return loaded;
  }
  static std::vector<Rig> characters() {
    std::vector<Rig> out;
    for (std::size_t k = 0; k < synth::kKinds.size(); ++k)
      out.push_back(synth::make_character(synth::kKinds[k], 7, {32, synth::Finish::BySeed}));
    return out;
  }
};

// Mean over the vertices of the summed differences.
double l1(const SkinWeights& a, const SkinWeights& b, std::size_t joints) {
  double sum = 0.0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    std::vector<float> difference(joints, 0.0f);
    for (const Influence& i : a[VertexId(v)]) difference[index(i.joint)] += i.weight;
    for (const Influence& i : b[VertexId(v)]) difference[index(i.joint)] -= i.weight;
    for (const float d : difference) sum += std::abs(d);
  }
  return sum / static_cast<double>(a.size());
}

TEST_F(Precision, weights_of_bf16_are_within_their_budget) {
  double sum = 0.0;
  const std::vector<Rig> all = characters();
  for (const Rig& rig : all) {
    pipelines::RignetOptions options;
    options.skeleton = rig.skeleton;
    const auto weights = [&](const infer::RignetModels& m) { return pipelines::rig_character(rig.mesh, m, options).weights; };
    sum += l1(weights(models().f32), weights(models().bf16), rig.skeleton.size());
  }
  EXPECT_LE(sum / static_cast<double>(all.size()), 0.005);
}

// Of joints that both find; what is found at all is a threshold's decision, and a character on the edge of it may gain or lose one.
TEST_F(Precision, joints_of_bf16_are_within_their_budget) {
  double sum = 0.0, count = 0.0, same = 0.0;
  const std::vector<Rig> all = characters();
  for (const Rig& rig : all) {
    const auto a = pipelines::rig_character(rig.mesh, models().f32), b = pipelines::rig_character(rig.mesh, models().bf16);
    const float size = 1.0f / geometry::normalization_of(rig.mesh).scale;
    same += a.skeleton.size() == b.skeleton.size() ? 1.0 : 0.0;
    if (a.skeleton.size() != b.skeleton.size()) continue;
    for (const Vec3f& p : a.skeleton.rest_positions) {
      float nearest = INFINITY;
      for (const Vec3f& q : b.skeleton.rest_positions) nearest = std::min(nearest, (p - q).norm());
      sum += static_cast<double>(nearest / size);
      count += 1.0;
    }
  }
  EXPECT_LE(sum / count, 1e-3);
  EXPECT_GE(same, 0.8 * static_cast<double>(all.size()));
}

}  // namespace
}  // namespace osteon
