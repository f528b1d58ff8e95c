// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "osteon/synth/creatures.h"

namespace osteon::synth {
namespace {

// In metres, of an adult where a factor is 1. Drawn once, so that both sides agree.
struct Proportions {
  float size, build, legs, arms, head, shoulders;  // factors
  float arm_angle;                                 // below horizontal, radians: 0 is a T-pose
  int fingers;                                     // beside the thumb; 0: a mitten

  explicit Proportions(Random& random) {
    size = random.uniform(0.85f, 1.1f);
    build = random.uniform(0.85f, 1.25f);
    legs = random.uniform(0.9f, 1.08f);
    arms = random.uniform(0.92f, 1.08f);
    head = random.uniform(0.95f, 1.35f);
    shoulders = random.uniform(0.92f, 1.12f);
    arm_angle = random.uniform(0.0f, 50.0f) * std::numbers::pi_v<float> / 180.0f;
    const int counts[] = {4, 4, 3, 2, 0};
    fingers = counts[random.below(std::size(counts))];
  }
};

class BipedMaker {
 public:
  explicit BipedMaker(const Proportions& proportions) : p_(proportions), s_(proportions.size), b_(proportions.size * proportions.build) {}

  Body make() {
    add_trunk();
    add_head();
    add_leg();
    add_arm();
    return std::move(body_);
  }

 private:
  // Hips wide, waist narrow, chest wide; all flatter from front to back.
  void add_trunk() {
    const float hip = hip_height();
    const float z = -0.005f * s_;
    const auto cone = [&](JointId joint, const Vec3f& a, const Vec3f& b, float ra, float rb, float flatness) {
      body_.clothe(joint, {{a, b}, ra * b_, rb * b_, Vec3f::UnitZ(), flatness}, 0.09f * b_);
    };
    hips_ = body_.joint("Hips", std::nullopt, {0, hip, z});
    const JointId spine = body_.joint("Spine", hips_, {0, hip + 0.11f * s_, z});
    const JointId spine1 = body_.joint("Spine1", spine, {0, hip + 0.23f * s_, z});
    chest_ = body_.joint("Spine2", spine1, {0, hip + 0.36f * s_, z});
    cone(hips_, {0, hip - 0.05f * s_, z}, {0, hip + 0.05f * s_, z}, 0.148f, 0.14f, 0.72f);
    cone(spine, {0, hip + 0.11f * s_, z}, {0, hip + 0.18f * s_, z}, 0.127f, 0.125f, 0.74f);
    cone(spine1, {0, hip + 0.23f * s_, z}, {0, hip + 0.31f * s_, z}, 0.132f, 0.148f, 0.74f);
    cone(chest_, {0, hip + 0.37f * s_, z}, {0, hip + 0.45f * s_, z}, 0.155f, 0.115f, 0.70f);
  }

  void add_head() {
    const Vec3f neck_at = body_.at(chest_) + Vec3f(0, 0.165f, -0.012f) * s_;
    const Vec3f head_at = neck_at + Vec3f(0, 0.085f, 0.02f) * s_;
    const JointId neck = body_.joint("Neck", chest_, neck_at), head = body_.joint("Head", neck, head_at);
    const float h = p_.head * s_;
    body_.clothe(neck, {{neck_at, head_at}, 0.058f * b_, 0.052f * b_}, 0.05f * s_);
    body_.clothe(
        head,
        {{head_at + Vec3f(0, 0.105f, -0.01f) * h, head_at + Vec3f(0, 0.13f, -0.01f) * h}, 0.092f * h, 0.095f * h, Vec3f::UnitX(), 0.84f},
        0.03f * s_);
    body_.clothe(head, {{head_at + Vec3f(0, 0.02f, 0.035f) * h, head_at + Vec3f(0, 0.08f, 0.045f) * h}, 0.05f * h, 0.062f * h},
                 0.05f * h);  // jaw
    body_.clothe(head, {{head_at + Vec3f(0, 0.085f, 0.1f) * h, head_at + Vec3f(0, 0.06f, 0.115f) * h}, 0.009f * h, 0.013f * h},
                 0.015f * h);  // nose
  }

  void add_leg() {
    const float hip = hip_height();
    const Vec3f thigh(0.095f * b_, hip - 0.035f * s_, 0.0f), knee(0.105f * b_, 0.52f * leg_scale(), 0.012f * s_);
    const Vec3f ankle(0.11f * b_, 0.085f * s_, -0.02f * s_), ball(0.122f * b_, 0.03f * s_, 0.105f * s_),
        toe(0.126f * b_, 0.024f * s_, 0.165f * s_);
    const JointId up = body_.pair("UpLeg", hips_, thigh), low = body_.pair("Leg", up, knee);
    const JointId foot = body_.pair("Foot", low, ankle), toes = body_.pair("ToeBase", foot, ball);
    const Vec3f calf = knee + 0.33f * (ankle - knee) + Vec3f(0, 0, -0.018f * b_);
    body_.clothe(up, {{thigh, knee}, 0.088f * b_, 0.056f * b_}, 0.05f * b_);
    body_.clothe(low, {{knee, calf}, 0.053f * b_, 0.056f * b_}, 0.04f * b_);
    body_.clothe(low, {{calf, ankle}, 0.056f * b_, 0.037f * b_}, 0.04f * b_);
    body_.clothe(foot, {{ankle + Vec3f(0, -0.04f, -0.025f) * s_, ball}, 0.042f * s_, 0.034f * s_}, 0.04f * s_);
    body_.clothe(toes, {{ball, toe}, 0.036f * s_, 0.028f * s_, Vec3f::UnitY(), 0.8f}, 0.03f * s_);
  }

  void add_arm() {
    const Vec3f down = arm_direction();
    const Vec3f clavicle = body_.at(chest_) + Vec3f(0.035f, 0.105f, 0.0f) * s_;
    const Vec3f shoulder = body_.at(chest_) + Vec3f(0.178f * p_.shoulders, 0.105f, -0.01f) * s_;
    const float reach = p_.arms * s_;
    const Vec3f elbow = shoulder + 0.275f * reach * down + Vec3f(0, 0, -0.012f * s_),
                wrist = elbow + 0.25f * reach * down + Vec3f(0, 0, 0.018f * s_);
    const JointId collar = body_.pair("Shoulder", chest_, clavicle), upper = body_.pair("Arm", collar, shoulder);
    const JointId fore = body_.pair("ForeArm", upper, elbow);
    body_.clothe(collar, {{clavicle, shoulder}, 0.068f * b_, 0.062f * b_}, 0.07f * b_);
    body_.clothe(upper, {{shoulder, elbow}, 0.057f * b_, 0.04f * b_}, 0.05f * b_);
    body_.clothe(fore, {{elbow, elbow + 0.3f * (wrist - elbow)}, 0.039f * b_, 0.043f * b_}, 0.03f * b_);
    body_.clothe(fore, {{elbow + 0.3f * (wrist - elbow), wrist}, 0.043f * b_, 0.027f * b_}, 0.03f * b_);
    add_hand(fore, wrist, down);
  }

  // The palm lies flat, facing down in a T-pose; the thumb points forwards.
  void add_hand(JointId fore, const Vec3f& wrist, const Vec3f& along) {
    const Vec3f front = Vec3f::UnitZ(), back_of_hand = front.cross(along).normalized();
    const JointId hand = body_.pair("Hand", fore, wrist);
    const Vec3f knuckles = wrist + 0.085f * s_ * along;
    body_.clothe(hand, {{wrist + 0.02f * s_ * along, knuckles - 0.018f * s_ * along}, 0.032f * s_, 0.041f * s_, back_of_hand, 0.5f},
                 0.03f * s_);
    const Vec3f thumb_way = (0.75f * along + 0.62f * front).normalized();
    add_finger("HandThumb", hand, wrist + (0.028f * along + 0.024f * front) * s_, thumb_way, 0.03f, 0.0125f);
    if (p_.fingers == 0) {
      add_finger("HandMitten", hand, knuckles, along, 0.032f, 0.03f);
      return;
    }
    const char* names[] = {"HandIndex", "HandMiddle", "HandRing", "HandPinky"};
    const float lengths[] = {0.030f, 0.033f, 0.031f, 0.025f};
    const float spread = 0.072f / static_cast<float>(p_.fingers), radius = 0.036f / static_cast<float>(p_.fingers + 0.2f);
    for (int f = 0; f < p_.fingers; ++f) {
      const float offset = spread * (0.5f * static_cast<float>(p_.fingers - 1) - static_cast<float>(f));
      const Vec3f way = (along + 2.2f * offset * front).normalized();
      add_finger(names[f], hand, knuckles + offset * s_ * front, way, lengths[f], std::min(radius, 0.0145f));
    }
  }

  // Three joints; `length` of a phalanx and `radius` in metres of an adult.
  void add_finger(const std::string& name, JointId hand, const Vec3f& base, const Vec3f& way, float length, float radius) {
    const Vec3f step = length * s_ * way;
    const float r = radius * s_;
    add_chain(body_, hand, Rows::Paired,
              {{name + "1", base, r},
               {name + "2", base + step, 0.93f * r},
               {name + "3", base + 1.8f * step, 0.85f * r},
               {"", base + 2.4f * step, 0.75f * r}},
              0.35f);
  }

  float leg_scale() const { return s_ * p_.legs; }
  float hip_height() const { return 0.97f * leg_scale(); }
  Vec3f arm_direction() const { return {std::cos(p_.arm_angle), -std::sin(p_.arm_angle), 0.0f}; }

  const Proportions& p_;
  float s_, b_;  // metres per adult metre: lengths, thicknesses
  Body body_;
  JointId hips_{}, chest_{};
};

}  // namespace

Body make_biped(Random& random) {
  const Proportions proportions(random);
  return BipedMaker(proportions).make();
}

}  // namespace osteon::synth
