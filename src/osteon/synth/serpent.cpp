// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "osteon/synth/chain.h"
#include "osteon/synth/creatures.h"
#include "osteon/synth/head.h"

namespace osteon::synth {
namespace {

// In metres; a snake of 1.2 m where a factor is 1.
struct Proportions {
  float size, build, raise, arch, head;  // raise: of the head above the ground, in lengths of the neck; arch: of the body off the ground
  int joints;                            // along the body
  float spread;                          // length of horns or of the cobra's hood, 0: none
  bool hood;

  explicit Proportions(Random& random) {
    size = random.uniform(0.6f, 3.0f);
    build = random.uniform(0.7f, 2.2f);
    raise = random.below(3) == 0 ? 0.0f : random.uniform(0.2f, 1.0f);
    arch = random.below(2) == 0 ? 0.0f : random.uniform(0.5f, 2.0f);
    head = random.uniform(1.0f, 1.8f);
    joints = 4 + static_cast<int>(random.below(11));
    spread = random.below(3) == 0 ? random.uniform(0.5f, 1.2f) : 0.0f;
    hood = random.below(4) == 0;
  }
};

class SerpentMaker {
 public:
  SerpentMaker(const Proportions& proportions, const Habits& habits)
      : p_(proportions), habits_(habits), s_(proportions.size), r_(0.035f * proportions.size * proportions.build) {}

  Body make() {
    const Vec3f neck = add_trunk();
    HeadShape head{.radius = 1.1f * p_.head * r_, .width = 0.9f, .forward = 1.0f, .snout = 0.6f, .snout_width = 0.6f};
    head.eyes = 0.25f;
    head.horns = p_.spread;
    add_head(body_, neck_, neck, head, habits_);
    return std::move(body_);
  }

 private:
  // The root is where the raised neck leaves the trunk; the trunk runs back from it along waves that stand upright.
  Vec3f add_trunk() {
    constexpr int kSteps = 24;
    std::vector<ChainPoint> back, front;
    for (int i = 0; i <= kSteps; ++i) {
      const float t = static_cast<float>(i) / kSteps;
      const float wave = 1.0f - std::cos(4.0f * std::numbers::pi_v<float> * t);
      back.push_back({"", Vec3f(0, r_ + p_.arch * r_ * wave, -1.0f * s_ * t), r_ * (1.0f - 0.85f * t * t)});
    }
    auto points = jointed(back, "Spine", p_.joints);
    points.front().name = "Hips";
    points.back().name = joint_if(habits_.ends, "SpineEnd");
    const JointId root = add_chain(body_, std::nullopt, Rows::Single, points, 0.6f).front();
    const float length = 0.3f * s_;
    for (int i = 0; i <= kSteps / 3; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(kSteps / 3);
      front.push_back({"", Vec3f(0, r_ + p_.raise * length * t * t, (1.0f - 0.4f * p_.raise) * length * t), r_ * (1.0f - 0.2f * t)});
    }
    neck_ = add_chain(body_, root, Rows::Single, jointed(front, "Neck", 1 + p_.joints / 4), 0.6f).back();
    if (p_.hood) {
      const Vec3f middle = front[front.size() * 2 / 3].position;
      body_.clothe(neck_, {{middle, middle + 0.6f * (front.back().position - middle)}, 2.4f * r_, 1.6f * r_, Vec3f::UnitZ(), 0.3f},
                   0.4f * r_);
    }
    return front.back().position;
  }

  const Proportions& p_;
  const Habits& habits_;
  float s_, r_;  // metres per metre of the snake; its radius
  Body body_;
  JointId neck_{};
};

}  // namespace

Body make_serpent(Random& random) {
  const Proportions proportions(random);
  const Habits habits(random);
  return SerpentMaker(proportions, habits).make();
}

}  // namespace osteon::synth
