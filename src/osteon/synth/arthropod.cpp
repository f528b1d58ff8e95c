// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "osteon/synth/chain.h"
#include "osteon/synth/creatures.h"
#include "osteon/synth/habits.h"
#include "osteon/synth/pieces.h"
#include "osteon/synth/wing.h"

namespace osteon::synth {
namespace {

// In metres; a spider of 0.3 m leg span where a factor is 1.
struct Proportions {
  float size, build, reach, abdomen, stance, head, legs;  // factors; stance: height of the body; legs: their thickness
  int pairs;                                              // of legs: 3 an insect, 4 a spider, 5 and more a crab or a centipede
  int leg_joints, belly_joints;
  bool antennae = false, mandibles, eyes;
  std::optional<WingShape> wings;

  Proportions(Random& random, int leg_pairs) : pairs(leg_pairs) {
    size = random.uniform(0.5f, 6.0f);
    build = random.uniform(0.8f, 1.5f);
    reach = random.uniform(0.6f, 1.4f);
    abdomen = random.uniform(0.8f, 1.7f);
    stance = random.uniform(0.6f, 1.8f);
    head = random.uniform(0.8f, 1.9f);
    legs = random.uniform(0.8f, 1.5f);
    leg_joints = 1 + static_cast<int>(random.below(4));
    belly_joints = 1 + static_cast<int>(random.below(2));
    mandibles = random.below(3) == 0;
    eyes = random.below(2) == 0;
  }
};

class ArthropodMaker {
 public:
  ArthropodMaker(const Proportions& proportions, const Habits& habits)
      : p_(proportions),
        habits_(habits),
        s_(proportions.size),
        b_(proportions.size * proportions.build),
        half_length_(0.011f * s_ * static_cast<float>(p_.pairs)) {}

  Body make() {
    add_trunk();
    add_head();
    for (int leg = 0; leg < p_.pairs; ++leg) add_leg(leg);
    if (p_.antennae) add_antenna();
    if (p_.wings) add_spread_wings();
    return std::move(body_);
  }

 private:
  float height() const { return 0.055f * p_.stance * s_ + 0.01f * b_; }

  void add_trunk() {
    const float y = height(), front = half_length_, back = -half_length_;
    thorax_ = body_.joint("Thorax", std::nullopt, {0, y, back + habits_.root * half_length_});
    body_.clothe(thorax_, {{Vec3f(0, y, back), Vec3f(0, y, front)}, 0.03f * b_, 0.028f * b_, Vec3f::UnitY(), 0.75f}, 0.02f * b_);
    const float belly = 0.027f * p_.abdomen * b_;
    auto points = jointed({{"", {0, y + 0.004f * s_, back - 0.02f * s_}, 0.02f * b_},
                           {"", {0, y + 0.014f * s_, back - 0.02f * s_ - 0.9f * belly}, belly},
                           {"", {0, y + 0.012f * s_, back - 0.02f * s_ - 2.2f * belly}, 0.72f * belly}},
                          "Abdomen", p_.belly_joints);
    points.back().name = joint_if(habits_.ends, "AbdomenEnd");
    add_chain(body_, thorax_, Rows::Single, points, 0.6f);
  }

  void add_head() {
    const float r = 0.021f * p_.head * b_, y = height();
    const Vec3f base(0, y, half_length_ + 0.016f * s_), front = base + Vec3f(0, -0.2f, 0.9f) * r;
    head_ = add_chain(body_, thorax_, Rows::Single, {{"Head", base, r}, {"", front, 0.9f * r}}, 0.6f)[0];
    if (p_.eyes) body_.attach(head_, ball(front + Vec3f(0.55f, 0.45f, 0.4f) * r, 0.35f * r));
    if (p_.mandibles)
      add_chain(body_, head_, Rows::Paired,
                jointed({{"", front + Vec3f(0.4f, -0.3f, 0.5f) * r, 0.3f * r},
                         {"", front + Vec3f(0.6f, -0.6f, 1.2f) * r, 0.24f * r},
                         {"", front + Vec3f(0.25f, -0.8f, 1.7f) * r, 0.16f * r}},
                        "Mandible", habits_.jaw ? 1 : 0),
                0.5f);
  }

  // Legs fan out from front to back; each rises to its knee and comes down to the ground.
  void add_leg(int leg) {
    const float t = p_.pairs == 1 ? 0.5f : static_cast<float>(leg) / static_cast<float>(p_.pairs - 1);  // 0 front .. 1 back
    const float angle = (55.0f - 110.0f * t) * std::numbers::pi_v<float> / 180.0f;
    const Vec3f out(std::cos(angle), 0, std::sin(angle));
    const Vec3f hip(0.026f * b_, height() - 0.004f * s_, half_length_ * (1.0f - 2.0f * t));
    const auto at = [&](float reach, float y) { return Vec3f(Vec3f(hip.x(), y * s_, hip.z()) + reach * p_.reach * s_ * out); };
    const float lift = height() / s_, r = 0.0085f * p_.legs * b_;
    const std::string name = "Leg" + std::string(1, static_cast<char>('A' + leg));
    const std::vector<ChainPoint> shape{{joint_if(p_.leg_joints > 0, name + "Coxa"), hip, 1.1f * r},
                                        {joint_if(p_.leg_joints > 3, name + "Femur"), at(0.02f, lift + 0.008f), 1.1f * r},
                                        {joint_if(p_.leg_joints > 1, name + "Tibia"), at(0.068f, lift + 0.042f), 0.9f * r},
                                        {joint_if(p_.leg_joints > 2, name + "Tarsus"), at(0.112f, 0.4f * lift), 0.72f * r},
                                        {joint_if(habits_.ends && p_.leg_joints > 0, name + "End"), at(0.135f, 0.005f), 0.55f * r}};
    add_chain(body_, thorax_, Rows::Paired, shape, 0.8f);
  }

  void add_antenna() {
    const float r = 0.021f * p_.head * b_;
    const Vec3f base = body_.at(head_) + Vec3f(0.35f, 0.6f, 0.8f) * r;
    add_chain(body_, head_, Rows::Paired,
              jointed({{"", base, 0.0065f * s_},
                       {"", base + Vec3f(0.015f, 0.03f, 0.03f) * s_, 0.0055f * s_},
                       {"", base + Vec3f(0.035f, 0.045f, 0.07f) * s_, 0.005f * s_}},
                      "Antenna", habits_.ears ? 2 : 0),
              0.8f);
  }

  void add_spread_wings() {
    WingShape wings = *p_.wings;
    wings.span *= s_;
    wings.shoulder = {0.012f * b_, height() + 0.018f * b_, 0.3f * half_length_};
    add_wings(body_, thorax_, wings, habits_);
  }

  const Proportions& p_;
  const Habits& habits_;
  float s_, b_;        // metres per metre of the spider: lengths, thicknesses
  float half_length_;  // of the thorax: its legs need room
  Body body_;
  JointId thorax_{}, head_{};
};

}  // namespace

Body make_insect(Random& random) {
  Proportions proportions(random, 3);
  proportions.antennae = random.below(4) != 0;
  proportions.leg_joints = static_cast<int>(random.below(4));
  if (random.below(2) == 0) {
    proportions.wings = WingShape{.style = WingStyle::Webbed};
    proportions.build *= random.uniform(1.0f, 1.8f);
    proportions.wings->span = random.uniform(0.12f, 0.35f);
    proportions.wings->chord = random.uniform(0.25f, 0.5f);
    proportions.wings->rise = random.uniform(0.1f, 0.8f);
    proportions.wings->sweep = random.uniform(0.0f, 0.8f);
    proportions.wings->joints = 1 + static_cast<int>(random.below(2));
  }
  return ArthropodMaker(proportions, Habits(random)).make();
}

Body make_spider(Random& random) {
  const Proportions proportions(random, 4);
  return ArthropodMaker(proportions, Habits(random)).make();
}

Body make_many_legged(Random& random) {
  Proportions proportions(random, 5 + static_cast<int>(random.below(3)));
  proportions.antennae = random.below(2) == 0;
  return ArthropodMaker(proportions, Habits(random)).make();
}

}  // namespace osteon::synth
