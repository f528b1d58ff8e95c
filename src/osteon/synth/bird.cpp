// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "osteon/synth/creatures.h"

namespace osteon::synth {
namespace {

// In metres; lengths of a crow, standing with its wings spread, where a factor is 1.
struct Proportions {
  float size, build, legs, neck, wings, beak, tail;  // factors
  float dihedral;                                    // how far the wings rise, per metre

  explicit Proportions(Random& random) {
    size = random.uniform(0.5f, 2.5f);
    build = random.uniform(0.85f, 1.25f);
    legs = random.uniform(0.7f, 2.2f);
    neck = random.uniform(0.6f, 2.2f);
    wings = random.uniform(0.75f, 1.35f);
    beak = random.uniform(0.6f, 1.8f);
    tail = random.uniform(0.7f, 1.4f);
    dihedral = random.uniform(-0.1f, 0.35f);
  }
};

class BirdMaker {
 public:
  explicit BirdMaker(const Proportions& proportions) : p_(proportions), s_(proportions.size), b_(proportions.size * proportions.build) {}

  Body make() {
    add_trunk();
    add_head();
    add_wing();
    add_leg();
    return std::move(body_);
  }

 private:
  float height() const { return (0.085f + 0.1f * p_.legs) * s_; }

  void add_trunk() {
    const float y = height();
    const auto spine = add_chain(body_, std::nullopt, Rows::Single,
                                 {{"Hips", {0, y, -0.06f * s_}, 0.052f * b_},
                                  {"Spine", {0, y + 0.015f * s_, 0.0f}, 0.066f * b_},
                                  {"Chest", {0, y + 0.03f * s_, 0.055f * s_}, 0.062f * b_},
                                  {"", {0, y + 0.045f * s_, 0.09f * s_}, 0.046f * b_}},
                                 0.9f);
    hips_ = spine[0];
    chest_ = spine[2];
    const Vec3f base(0, y - 0.002f * s_, -0.1f * s_), way(0, -0.018f * s_, -0.1f * p_.tail * s_);
    add_chain(body_, hips_, Rows::Single,
              {{"Tail", base, 0.036f * b_}, {"Tail1", base + 0.8f * way, 0.036f * b_}, {"", base + 1.7f * way, 0.042f * b_}}, 0.7f,
              {{}, 0, 0, Vec3f::UnitY(), 0.3f});
  }

  void add_head() {
    const Vec3f base = body_.at(chest_) + Vec3f(0, 0.03f, 0.035f) * s_, rise = Vec3f(0, 0.052f, 0.018f) * p_.neck * s_;
    const Vec3f top = base + 2.0f * rise;
    const auto neck = add_chain(body_, chest_, Rows::Single,
                                {{"Neck", base, 0.038f * b_}, {"Neck1", base + rise, 0.029f * b_}, {"", top, 0.027f * b_}}, 0.9f);
    const JointId head = body_.joint("Head", neck.back(), top);
    body_.clothe(head, {{top + Vec3f(0, 0.012f, 0.004f) * s_, top + Vec3f(0, 0.012f, 0.016f) * s_}, 0.037f * s_, 0.034f * s_}, 0.025f * s_);
    const Vec3f beak = top + Vec3f(0, 0.008f, 0.04f) * s_, tip = beak + Vec3f(0, -0.01f, 0.055f * p_.beak) * s_;
    body_.clothe(head, {{beak, tip}, 0.016f * s_, 0.006f * s_}, 0.01f * s_);
    add_chain(body_, head, Rows::Single,
              {{"Jaw", beak + Vec3f(0, -0.014f, -0.008f) * s_, 0.011f * s_}, {"", tip + Vec3f(0, -0.012f, -0.012f) * s_, 0.005f * s_}},
              0.6f);
  }

  void add_wing() {
    const float span = 0.13f * p_.wings * s_;
    const Vec3f shoulder = body_.at(chest_) + Vec3f(0.05f * b_, 0.028f * s_, -0.012f * s_);
    const auto out = [&](float x, float z) { return Vec3f(shoulder + Vec3f(x * span, x * span * p_.dihedral, z * s_)); };
    const RoundCone flat{{}, 0, 0, Vec3f(-p_.dihedral, 1, 0).normalized(), 0.28f};
    add_chain(body_, chest_, Rows::Paired,
              {{"Arm", out(0, 0), 0.05f * s_},
               {"ForeArm", out(0.9f, -0.012f), 0.055f * s_},
               {"Hand", out(1.9f, -0.004f), 0.052f * s_},
               {"Fingers", out(2.75f, -0.02f), 0.042f * s_},
               {"", out(3.4f, -0.045f), 0.022f * s_}},
              0.7f, flat);
  }

  void add_leg() {
    const float x = 0.034f * b_, knee = 0.02f * s_ + 0.62f * (height() - 0.05f * s_);
    const Vec3f thigh(x, height() - 0.03f * s_, -0.025f * s_), shin(x, knee, -0.005f * s_), ankle(x, 0.02f * s_, -0.02f * s_);
    const auto leg =
        add_chain(body_, hips_, Rows::Paired, {{"UpLeg", thigh, 0.032f * b_}, {"Leg", shin, 0.015f * b_}, {"", ankle, 0.01f * b_}}, 0.8f);
    const JointId foot = body_.pair("Foot", leg.back(), ankle);
    body_.clothe(foot, {{ankle, ankle + Vec3f(0, -0.008f, -0.03f) * s_}, 0.011f * s_, 0.007f * s_}, 0.008f * s_);
    const char* names[] = {"ToeIn", "ToeMiddle", "ToeOut"};
    for (int t = 0; t < 3; ++t) {
      const Vec3f way = Vec3f(0.55f * static_cast<float>(t - 1), -0.12f, 1.0f).normalized();
      add_chain(body_, foot, Rows::Paired,
                {{names[t], ankle + 0.008f * s_ * way, 0.0105f * s_}, {"", ankle + 0.06f * s_ * way, 0.0075f * s_}}, 0.5f);
    }
  }

  const Proportions& p_;
  float s_, b_;  // metres per metre of the crow: lengths, thicknesses
  Body body_;
  JointId hips_{}, chest_{};
};

}  // namespace

Body make_bird(Random& random) {
  const Proportions proportions(random);
  return BirdMaker(proportions).make();
}

}  // namespace osteon::synth
