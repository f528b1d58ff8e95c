// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "osteon/synth/creatures.h"

namespace osteon::synth {
namespace {

// In metres; lengths of a middling dog where a factor is 1.
struct Proportions {
  float size, length, height, build, neck, snout, ear, tail;  // factors; neck: 0 hangs low, 1 stands up
  int tail_joints;

  explicit Proportions(Random& random) {
    size = random.uniform(0.6f, 2.2f);
    length = random.uniform(0.85f, 1.25f);
    height = random.uniform(0.75f, 1.2f);
    build = random.uniform(0.85f, 1.35f);
    neck = random.uniform(0.2f, 1.0f);
    snout = random.uniform(0.6f, 1.4f);
    ear = random.uniform(0.6f, 1.8f);
    tail = random.uniform(0.5f, 1.6f);
    tail_joints = 2 + static_cast<int>(random.below(4));
  }
};

class QuadrupedMaker {
 public:
  explicit QuadrupedMaker(const Proportions& proportions)
      : p_(proportions), s_(proportions.size), b_(proportions.size * proportions.build) {}

  Body make() {
    add_trunk();
    add_head();
    add_tail();
    add_hind_leg();
    add_front_leg();
    return std::move(body_);
  }

 private:
  float back_height() const { return 0.48f * p_.height * s_; }
  float along(float z) const { return z * p_.length * s_; }

  void add_trunk() {
    const float y = back_height();
    const auto spine = add_chain(body_, std::nullopt, Rows::Single,
                                 {{"Hips", {0, y, along(-0.26f)}, 0.092f * b_},
                                  {"Spine", {0, y + 0.005f * s_, along(-0.09f)}, 0.09f * b_},
                                  {"Spine1", {0, y, along(0.08f)}, 0.108f * b_},
                                  {"Chest", {0, y - 0.01f * s_, along(0.22f)}, 0.11f * b_},
                                  {"", {0, y + 0.005f * s_, along(0.28f)}, 0.095f * b_}},
                                 0.7f, {{}, 0, 0, Vec3f::UnitX(), 0.82f});
    hips_ = spine.front();
    chest_ = spine.back();
  }

  void add_head() {
    const Vec3f base = body_.at(chest_) + Vec3f(0, 0.035f * s_, along(0.07f));
    const Vec3f way = Vec3f(0, 0.25f + 0.75f * p_.neck, 0.85f - 0.45f * p_.neck).normalized();
    const Vec3f middle = base + 0.1f * s_ * way, top = base + 0.19f * s_ * way, nose = top + Vec3f(0, -0.035f, 0.145f * p_.snout) * s_;
    const auto neck =
        add_chain(body_, chest_, Rows::Single, {{"Neck", base, 0.078f * b_}, {"Neck1", middle, 0.064f * b_}, {"", top, 0.058f * b_}}, 0.8f);
    const JointId head = body_.joint("Head", neck.back(), top);
    body_.clothe(head, {{top + Vec3f(0, 0.012f, 0.01f) * s_, top + Vec3f(0, 0.008f, 0.04f) * s_}, 0.07f * s_, 0.064f * s_}, 0.05f * s_);
    body_.clothe(head, {{top + Vec3f(0, -0.005f, 0.05f) * s_, nose}, 0.048f * s_, 0.03f * s_}, 0.04f * s_);
    const Vec3f jaw_at = top + Vec3f(0, -0.035f, 0.035f) * s_;
    add_chain(body_, head, Rows::Single, {{"Jaw", jaw_at, 0.034f * s_}, {"", nose + Vec3f(0, -0.032f, -0.025f) * s_, 0.019f * s_}}, 0.8f);
    const Vec3f ear = top + Vec3f(0.042f, 0.062f, 0.0f) * s_, up = Vec3f(0.018f, 0.06f, -0.008f) * p_.ear * s_;
    add_chain(body_, head, Rows::Paired,
              {{"Ear", ear, 0.024f * s_}, {"Ear1", ear + 0.6f * up, 0.022f * s_}, {"", ear + 1.1f * up, 0.011f * s_}}, 0.8f,
              {{}, 0, 0, Vec3f::UnitZ(), 0.55f});
  }

  void add_tail() {
    std::vector<ChainPoint> points;
    const float length = 0.34f * p_.tail * s_;
    const Vec3f base = body_.at(hips_) + Vec3f(0, 0.045f * s_, along(-0.075f));
    for (int i = 0; i <= p_.tail_joints; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(p_.tail_joints);
      points.push_back({i == 0 ? "Tail" : "Tail" + std::to_string(i), base + length * Vec3f(0, 0.2f * t - 0.75f * t * t, -0.85f * t),
                        (0.034f - 0.02f * t) * b_});
    }
    add_chain(body_, hips_, Rows::Single, points, 0.8f);
  }

  void add_hind_leg() {
    const float y = back_height(), x = 0.07f * b_, z = along(-0.27f);
    add_chain(body_, hips_, Rows::Paired,
              {{"UpLeg", {x, y - 0.03f * s_, z}, 0.078f * b_},
               {"Leg", {x + 0.012f * b_, 0.56f * y, z + 0.055f * s_}, 0.045f * b_},
               {"Foot", {x + 0.012f * b_, 0.28f * y, z - 0.075f * s_}, 0.028f * b_},
               {"Toes", {x + 0.012f * b_, 0.03f * s_, z - 0.035f * s_}, 0.03f * b_},
               {"", {x + 0.012f * b_, 0.026f * s_, z + 0.025f * s_}, 0.027f * b_}},
              0.8f);
  }

  void add_front_leg() {
    const float y = back_height(), x = 0.072f * b_, z = along(0.23f);
    add_chain(body_, chest_, Rows::Paired,
              {{"Shoulder", {x, y + 0.02f * s_, z - 0.02f * s_}, 0.06f * b_},
               {"Arm", {x + 0.008f * b_, 0.78f * y, z + 0.045f * s_}, 0.056f * b_},
               {"ForeArm", {x + 0.01f * b_, 0.56f * y, z - 0.02f * s_}, 0.04f * b_},
               {"Hand", {x + 0.01f * b_, 0.2f * y, z + 0.0f * s_}, 0.028f * b_},
               {"Fingers", {x + 0.01f * b_, 0.03f * s_, z + 0.015f * s_}, 0.03f * b_},
               {"", {x + 0.01f * b_, 0.026f * s_, z + 0.065f * s_}, 0.026f * b_}},
              0.8f);
  }

  const Proportions& p_;
  float s_, b_;  // metres per metre of the middling dog: lengths, thicknesses
  Body body_;
  JointId hips_{}, chest_{};
};

}  // namespace

Body make_quadruped(Random& random) {
  const Proportions proportions(random);
  return QuadrupedMaker(proportions).make();
}

}  // namespace osteon::synth
