// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "osteon/synth/creatures.h"

namespace osteon::synth {
namespace {

// In metres; a spider of 0.3 m leg span where a factor is 1.
struct Proportions {
  float size, build, reach, abdomen, stance;  // factors; stance: height of the body
  int pairs;                                  // of legs: 3 an insect, 4 a spider, 5 and more a crab or a centipede
  bool antennae;

  explicit Proportions(Random& random) {
    size = random.uniform(0.5f, 4.0f);
    build = random.uniform(0.8f, 1.3f);
    reach = random.uniform(0.8f, 1.3f);
    abdomen = random.uniform(0.8f, 1.5f);
    stance = random.uniform(0.7f, 1.3f);
    pairs = 3 + static_cast<int>(random.below(4));
    antennae = random.below(2) == 1;
  }
};

class ManyLeggedMaker {
 public:
  explicit ManyLeggedMaker(const Proportions& proportions)
      : p_(proportions),
        s_(proportions.size),
        b_(proportions.size * proportions.build),
        half_length_(0.011f * s_ * static_cast<float>(p_.pairs)) {}

  Body make() {
    add_trunk();
    for (int leg = 0; leg < p_.pairs; ++leg) add_leg(leg);
    if (p_.antennae) add_antenna();
    return std::move(body_);
  }

 private:
  float height() const { return 0.055f * p_.stance * s_; }

  void add_trunk() {
    const RoundCone low{{}, 0, 0, Vec3f::UnitY(), 0.75f};
    const float y = height(), front = half_length_, back = -half_length_;
    thorax_ = add_chain(body_, std::nullopt, Rows::Single, {{"Thorax", {0, y, back}, 0.03f * b_}, {"", {0, y, front}, 0.028f * b_}}, 0.8f,
                        low)[0];
    head_ = add_chain(body_, thorax_, Rows::Single,
                      {{"Head", {0, y, front + 0.018f * s_}, 0.021f * b_}, {"", {0, y - 0.004f * s_, front + 0.032f * s_}, 0.018f * b_}},
                      0.6f)[0];
    const float belly = 0.027f * p_.abdomen * b_;
    add_chain(body_, thorax_, Rows::Single,
              {{"Abdomen", {0, y + 0.004f * s_, back - 0.024f * s_}, 0.02f * b_},
               {"Abdomen1", {0, y + 0.014f * s_, back - 0.02f * s_ - 0.9f * belly}, belly},
               {"", {0, y + 0.012f * s_, back - 0.02f * s_ - 1.9f * belly}, 0.72f * belly}},
              0.6f);
  }

  // Legs fan out from front to back; each rises to its knee and comes down to the ground.
  void add_leg(int leg) {
    const float t = p_.pairs == 1 ? 0.5f : static_cast<float>(leg) / static_cast<float>(p_.pairs - 1);  // 0 front .. 1 back
    const float angle = (55.0f - 110.0f * t) * std::numbers::pi_v<float> / 180.0f;
    const Vec3f out(std::cos(angle), 0, std::sin(angle));
    const Vec3f hip(0.026f * b_, height() - 0.004f * s_, half_length_ * (1.0f - 2.0f * t));
    const auto at = [&](float reach, float y) { return Vec3f(Vec3f(hip.x(), y * s_, hip.z()) + reach * p_.reach * s_ * out); };
    const float lift = 0.05f * p_.stance;
    const std::string name = "Leg" + std::to_string(leg + 1);
    add_chain(body_, thorax_, Rows::Paired,
              {{name + "Coxa", hip, 0.0095f * b_},
               {name + "Femur", at(0.02f, lift + 0.008f), 0.0095f * b_},
               {name + "Tibia", at(0.068f, lift + 0.042f), 0.0075f * b_},
               {name + "Tarsus", at(0.112f, 0.4f * lift), 0.006f * b_},
               {"", at(0.135f, 0.005f), 0.0045f * b_}},
              0.8f);
  }

  void add_antenna() {
    const Vec3f base = body_.at(head_) + Vec3f(0.009f, 0.012f, 0.022f) * s_;
    add_chain(body_, head_, Rows::Paired,
              {{"Antenna", base, 0.0055f * s_},
               {"Antenna1", base + Vec3f(0.015f, 0.03f, 0.03f) * s_, 0.0045f * s_},
               {"", base + Vec3f(0.035f, 0.045f, 0.07f) * s_, 0.004f * s_}},
              0.8f);
  }

  const Proportions& p_;
  float s_, b_;        // metres per metre of the spider: lengths, thicknesses
  float half_length_;  // of the thorax: its legs need room
  Body body_;
  JointId thorax_{}, head_{};
};

}  // namespace

Body make_many_legged(Random& random) {
  const Proportions proportions(random);
  return ManyLeggedMaker(proportions).make();
}

}  // namespace osteon::synth
