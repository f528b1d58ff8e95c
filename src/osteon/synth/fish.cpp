// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "osteon/synth/creatures.h"

namespace osteon::synth {
namespace {

// In metres; a trout of 0.4 m where a factor is 1.
struct Proportions {
  float size, depth, width, fins, tail;  // factors
  int spine_joints;

  explicit Proportions(Random& random) {
    size = random.uniform(0.5f, 6.0f);
    depth = random.uniform(0.8f, 1.5f);
    width = random.uniform(0.45f, 0.85f);
    fins = random.uniform(0.7f, 1.5f);
    tail = random.uniform(0.7f, 1.4f);
    spine_joints = 4 + static_cast<int>(random.below(4));
  }
};

// Half the height of the body at t = 0 (head) .. 1 (root of the tail).
float profile(float t) { return 0.013f + 0.034f * std::sqrt(std::sin(3.1f * std::min(0.12f + 0.84f * t, 1.0f))); }

class FishMaker {
 public:
  explicit FishMaker(const Proportions& proportions) : p_(proportions), s_(proportions.size) {}

  Body make() {
    add_spine();
    add_tail();
    add_fins();
    return std::move(body_);
  }

 private:
  Vec3f on_axis(float t) const { return {0, 0.12f * p_.depth * s_, (0.12f - 0.36f * t) * s_}; }
  float radius(float t) const { return profile(t) * p_.depth * s_; }

  // The root is the head's end of the spine, where a swimming fish turns least; the head looks forward from there.
  void add_spine() {
    const RoundCone narrow{{}, 0, 0, Vec3f::UnitX(), p_.width};
    std::vector<ChainPoint> points;
    for (int i = 0; i <= p_.spine_joints; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(p_.spine_joints);
      points.push_back({i == 0 ? "Root" : "Spine" + std::to_string(i), on_axis(t), radius(t)});
    }
    spine_ = add_chain(body_, std::nullopt, Rows::Single, points, 0.9f, narrow);
    const JointId head = body_.joint("Head", spine_.front(), on_axis(-0.05f));
    body_.clothe(head, {{on_axis(-0.05f), on_axis(-0.2f)}, 0.96f * radius(0.0f), 0.02f * p_.depth * s_, Vec3f::UnitX(), p_.width},
                 0.03f * s_);
    const Vec3f jaw = on_axis(-0.13f) + Vec3f(0, -0.016f * p_.depth * s_, 0),
                chin = on_axis(-0.245f) + Vec3f(0, -0.015f * p_.depth * s_, 0);
    add_chain(body_, head, Rows::Single, {{"Jaw", jaw, 0.02f * p_.depth * s_}, {"", chin, 0.01f * p_.depth * s_}}, 0.9f, narrow);
  }

  void add_tail() {
    const float span = 0.045f * p_.tail * p_.depth * s_, r = 0.015f * p_.depth * s_;
    const RoundCone thin{{}, 0, 0, Vec3f::UnitX(), 0.4f};
    const auto tail =
        add_chain(body_, spine_.back(), Rows::Single, {{"Tail", on_axis(1.0f), 1.2f * r}, {"", on_axis(1.09f), r}}, 0.9f, thin);
    for (const auto& [name, up] : {std::pair("TailUpper", 1.0f), std::pair("TailLower", -1.0f)}) {
      const Vec3f base = on_axis(1.07f), tip = on_axis(1.28f) + Vec3f(0, up * span * 1.6f, 0);
      add_chain(body_, tail.back(), Rows::Single, {{name, base, r}, {"", tip, 0.6f * r}}, 1.2f, thin);
    }
  }

  void add_fins() {
    const std::size_t middle = spine_.size() / 2;
    const float at = 0.45f, r = 0.02f * p_.fins * s_;
    const Vec3f crest = on_axis(at) + Vec3f(0, 0.92f * radius(at), 0);
    add_chain(body_, spine_[middle], Rows::Single,
              {{"FinBack", crest, 1.3f * r},
               {"FinBack1", crest + Vec3f(0, 0.028f, -0.02f) * p_.fins * s_, r},
               {"", crest + Vec3f(0, 0.05f, -0.045f) * p_.fins * s_, 0.5f * r}},
              0.9f, {{}, 0, 0, Vec3f::UnitX(), 0.3f});
    const Vec3f side = on_axis(0.08f) + Vec3f(0.8f * p_.width * radius(0.08f), -0.35f * radius(0.08f), 0);
    const Vec3f out = Vec3f(0.045f, -0.022f, -0.035f) * p_.fins * s_;
    add_chain(body_, spine_.front(), Rows::Paired, {{"Fin", side, r}, {"Fin1", side + out, 0.95f * r}, {"", side + 1.8f * out, 0.5f * r}},
              0.8f, {{}, 0, 0, Vec3f(0.35f, 0.9f, 0.0f).normalized(), 0.3f});
  }

  const Proportions& p_;
  float s_;  // metres per metre of the trout
  Body body_;
  std::vector<JointId> spine_;
};

}  // namespace

Body make_fish(Random& random) {
  const Proportions proportions(random);
  return FishMaker(proportions).make();
}

}  // namespace osteon::synth
