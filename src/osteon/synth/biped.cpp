// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/biped.h"

#include <algorithm>
#include <cmath>

#include "osteon/synth/chain.h"
#include "osteon/synth/creatures.h"
#include "osteon/synth/hand.h"
#include "osteon/synth/pieces.h"

namespace osteon::synth {
namespace {

constexpr float kDegree = 0.01745329f;

class BipedMaker {
 public:
  BipedMaker(const BipedShape& shape, const Habits& habits)
      : p_(shape), habits_(habits), s_(shape.size), b_(shape.size * shape.build), limb_(shape.size * std::sqrt(shape.build)) {}

  Body make() {
    add_trunk();
    add_neck_and_head();
    add_leg();
    for (int pair = 0; pair < p_.arm_pairs; ++pair) add_arm(pair);
    if (p_.tail > 0.0f) add_tail();
    add_outfit();
    return std::move(body_);
  }

 private:
  float hip_height() const { return 0.95f * s_ * p_.legs; }
  // Half the width of the trunk at a share of its length from the hips to the shoulders.
  float girth(float t) const { return b_ * (0.147f + (p_.belly - 1.0f) * 0.13f * std::sin(3.14f * std::clamp(t + 0.1f, 0.0f, 1.0f))); }
  Vec3f on_trunk(float t) const { return {0, hip_height() + 0.5f * p_.torso * s_ * t, -0.005f * s_}; }

  // Hips wide, waist narrow, chest wide; all flatter from front to back, but for a paunch.
  void add_trunk() {
    const RoundCone flat{{}, 0, 0, Vec3f::UnitZ(), std::clamp(0.74f + 0.2f * (p_.belly - 1.0f), 0.7f, 0.95f)};
    const float waist = 0.16f, paunch = std::max(p_.belly - 1.2f, 0.0f) * 0.1f * b_;
    hips_ = body_.joint("Hips", std::nullopt, on_trunk(0.12f * habits_.root));
    add_chain(body_, hips_, Rows::Single, {{"", on_trunk(-0.06f), girth(0.0f)}, {"", on_trunk(waist), 0.92f * girth(waist)}}, 0.6f, flat);
    std::vector<ChainPoint> shape;
    for (const auto& [t, width] : {std::pair(waist, 0.92f), {0.3f, 0.85f}, {0.5f, 0.9f}, {0.75f, 1.03f}, {0.9f, 0.75f}})
      shape.push_back({"", on_trunk(t) + Vec3f(0, 0, t > 0.2f && t < 0.6f ? paunch : 0.0f), width * girth(t)});
    const auto spine = add_chain(body_, hips_, Rows::Single, jointed(shape, "Spine", habits_.spine), 0.6f, flat);
    chest_ = spine.empty() ? hips_ : spine.back();
  }

  void add_neck_and_head() {
    const float r = p_.head.radius;
    const Vec3f base = on_trunk(1.02f) + Vec3f(0, 0, -0.012f * s_), top = base + Vec3f(0, 0.07f * s_ + 0.1f * r, 0.015f * s_);
    const float wide = std::min(0.058f * limb_ + 0.1f * r, 0.6f * r);
    const auto neck =
        add_chain(body_, chest_, Rows::Single, jointed({{"", base, wide}, {"", top, 0.9f * wide}}, "Neck", habits_.neck), 0.8f);
    add_head(body_, neck.empty() ? chest_ : neck.back(), top, p_.head, habits_);
  }

  void add_leg() {
    const float hip = hip_height(), r = 0.088f * limb_ * (0.7f + 0.3f * p_.build), x = std::max(0.62f * girth(0.0f), 1.2f * r);
    const float f = p_.feet * s_, ankle_y = std::min(0.085f * f, 0.3f * hip);
    const float forward = 0.3f * hip * std::sin(p_.knee);
    const Vec3f thigh(x, hip - 0.03f * s_, 0), knee(x + 0.01f * s_, 0.5f * hip, forward + 0.012f * s_),
        ankle(x + 0.015f * s_, ankle_y, -0.02f * s_);
    const Vec3f ball = ankle + Vec3f(0.012f * f, 0.032f * f - ankle_y, 0.12f * f), toe = ball + Vec3f(0.004f, -0.004f, 0.06f) * f;
    const Vec3f calf = knee + 0.33f * (ankle - knee) + Vec3f(0, 0, -0.018f * limb_);
    const auto leg = add_chain(body_, hips_, Rows::Paired,
                               {{"UpLeg", thigh, r},
                                {joint_if(habits_.knees, "Leg"), knee, 0.62f * r},
                                {"", calf, 0.65f * r},
                                {joint_if(habits_.ankles, "Foot"), ankle, 0.45f * r}},
                               0.4f);
    const JointId foot = leg.back();
    body_.clothe(foot, {{ankle + Vec3f(0, 0.036f * f - ankle_y, -0.02f * f), ball}, 0.042f * f, 0.036f * f}, 0.035f * f);
    body_.clothe(foot, {{ankle, ankle + Vec3f(0, 0.03f * f - ankle_y, 0.02f * f)}, 0.42f * r, 0.04f * f}, 0.03f * f);
    add_chain(body_, foot, Rows::Paired,
              {{joint_if(habits_.toes, "ToeBase"), ball, 0.037f * f}, {joint_if(habits_.toes && habits_.ends, "ToeEnd"), toe, 0.03f * f}},
              0.8f);
  }

  // Arms hang no lower than the flanks and the paunch allow.
  Vec3f arm_direction(const Vec3f& shoulder, float reach, float radius) const {
    float angle = p_.arm_angle;
    const auto hand_at = [&] { return Vec3f(shoulder + reach * Vec3f(std::cos(angle), -std::sin(angle), 0)); };
    const auto too_near = [&] {
      for (const float t : {0.4f, 0.7f, 1.0f}) {
        const Vec3f p = shoulder + t * (hand_at() - shoulder);
        const float up = (p.y() - hip_height()) / (0.5f * p_.torso * s_);
        if (up < 0.9f && p.x() < std::max(girth(up), girth(0.0f) * 1.15f) + radius + 0.03f * s_) return true;
      }
      return false;
    };
    while (angle > 0.0f && too_near()) angle -= 5.0f * kDegree;
    angle = std::max(angle, 0.0f);
    return {std::cos(angle), -std::sin(angle), 0.0f};
  }

  // Further pairs of arms stand lower, and lower their hands.
  void add_arm(int pair) {
    const float reach = 0.27f * p_.arms * s_, r = 0.055f * limb_, level = 0.88f - 0.26f * static_cast<float>(pair);
    const std::string name = pair == 0 ? "" : "Lower" + std::to_string(pair);
    const Vec3f clavicle = on_trunk(level) + Vec3f(0.035f * s_, 0, 0.01f * s_);
    const Vec3f shoulder = on_trunk(level) + Vec3f(std::max(1.12f * girth(level) * p_.shoulders, 0.7f * girth(level) + r), 0, -0.005f * s_);
    Vec3f way = arm_direction(shoulder, 2.3f * reach, r);
    if (p_.arm_pairs > 1) way = (way + Vec3f(0, 0.35f - 0.4f * static_cast<float>(pair), 0)).normalized();
    const Vec3f elbow = shoulder + reach * way;
    const Vec3f bent = (std::cos(p_.elbow) * way + std::sin(p_.elbow) * Vec3f::UnitZ()).normalized(), wrist = elbow + 0.93f * reach * bent;
    const Vec3f muscle = elbow + 0.3f * (wrist - elbow);
    const auto collar = add_chain(body_, chest_, Rows::Paired,
                                  {{joint_if(habits_.clavicles, name + "Shoulder"), clavicle, 1.2f * r}, {"", shoulder, 1.12f * r}}, 0.9f);
    const auto arm = add_chain(body_, collar.empty() ? chest_ : collar.back(), Rows::Paired,
                               {{name + "Arm", shoulder, 1.05f * r},
                                {joint_if(habits_.knees, name + "ForeArm"), elbow, 0.74f * r},
                                {"", muscle, 0.78f * r},
                                {"", wrist, 0.52f * r}},
                               0.7f);
    const JointId hand = add_hand(body_, arm.back(), wrist, bent, {p_.hands * s_, p_.fingers, name}, habits_);
    if (pair == 0) add_held(hand, wrist + 0.06f * p_.hands * s_ * bent, bent);
  }

  // What the right hand holds points forwards; a shield on the left stands beside the hand.
  void add_held(JointId hand, const Vec3f& palm, const Vec3f& arm) {
    const Vec3f down = (arm.cross(Vec3f::UnitZ()).y() > 0 ? -1.0f : 1.0f) * arm.cross(Vec3f::UnitZ()).normalized();
    const Vec3f along = (Vec3f::UnitZ() - arm * arm.z()).normalized();
    const auto mirrored = [](const Vec3f& p) { return Vec3f(-p.x(), p.y(), p.z()); };
    if (p_.outfit.left != Held::None) body_.attach(hand, held(p_.outfit.left, palm, along, -down, s_), Copies::One);
    if (p_.outfit.right != Held::None)
      body_.attach(body_.mirrored(hand), held(p_.outfit.right, mirrored(palm), mirrored(along), mirrored(down), s_), Copies::One);
  }

  void add_outfit() {
    if (p_.outfit.backpack) {
      const float width = 1.5f * girth(0.8f);
      body_.attach(chest_, backpack(on_trunk(0.7f) - Vec3f(0, 0, 0.7f * girth(0.8f)), width, 1.3f * width), Copies::One);
    }
    if (p_.outfit.skirt > 0.0f && p_.tail == 0.0f) add_skirt();
    if (p_.outfit.belt) body_.attach(hips_, belt(on_trunk(0.1f), 1.08f * girth(0.1f), 0.85f * girth(0.1f), 0.05f * s_), Copies::One);
  }

  // A tube from the waist over the thighs.
  void add_skirt() {
    const float top = girth(0.15f), length = p_.outfit.skirt * 0.8f * hip_height(), flare = 0.35f * length;
    std::vector<Ring> rings;
    for (int i = 0; i <= 6; ++i) {
      const float t = static_cast<float>(i) / 6.0f, width = 1.05f * top + t * flare + 0.05f * s_;
      rings.push_back({on_trunk(0.15f) - Vec3f(0, t * length, 0), width, 0.85f * width});
    }
    body_.drape(hips_, tube(rings, 18), Copies::One);
  }

  void add_tail() {
    std::vector<ChainPoint> shape;
    const float length = 0.7f * p_.tail * s_;
    const Vec3f base = on_trunk(0.0f) - Vec3f(0, 0, 0.5f * girth(0.0f));
    for (int i = 0; i <= 6; ++i) {
      const float t = static_cast<float>(i) / 6.0f;
      const float y = std::max(base.y() - length * (1.1f * t - 0.6f * t * t), 0.06f * s_);
      shape.push_back({"", {0, y, base.z() - length * (0.35f * t + 0.6f * t * t)}, 0.07f * p_.tail_thickness * b_ * (1.0f - 0.75f * t)});
    }
    auto points = jointed(shape, "Tail", habits_.tail);
    points.back().name = joint_if(habits_.ends, "TailEnd");
    add_chain(body_, hips_, Rows::Single, points, 0.7f);
  }

  const BipedShape& p_;
  const Habits& habits_;
  float s_, b_, limb_;  // metres per adult metre: lengths, thicknesses of the trunk, of the limbs
  Body body_;
  JointId hips_{}, chest_{};
};

}  // namespace

BipedShape::BipedShape(Random& random) {
  const float toy = std::max(random.uniform(-0.8f, 1.0f), 0.0f);  // 0: as in nature .. 1: a doll with a big head
  size = random.uniform(0.8f, 1.15f) * (1.0f - 0.4f * toy);
  build = random.uniform(0.75f, 1.35f) * (1.0f + 0.3f * toy);
  belly = random.below(3) == 0 ? random.uniform(1.2f, 1.9f) : random.uniform(0.75f, 1.2f);
  torso = random.uniform(0.85f, 1.15f);
  legs = random.uniform(0.85f, 1.1f) * (1.0f - 0.4f * toy);
  arms = random.uniform(0.85f, 1.15f) * (1.0f - 0.2f * toy);
  shoulders = random.uniform(0.9f, 1.2f);
  hands = random.uniform(0.95f, 1.3f) * (1.0f + 0.5f * toy);
  feet = random.uniform(0.9f, 1.3f) * (1.0f + 0.4f * toy);
  const float poses[] = {0.0f, random.uniform(0.0f, 8.0f), random.uniform(30.0f, 55.0f), random.uniform(30.0f, 55.0f),
                         random.uniform(65.0f, 80.0f)};
  arm_angle = poses[random.below(std::size(poses))] * kDegree;
  elbow = random.below(2) == 0 ? random.uniform(0.0f, 6.0f) * kDegree : random.uniform(5.0f, 35.0f) * kDegree;
  knee = random.below(3) == 0 ? random.uniform(0.05f, 0.35f) : 0.0f;
  arm_pairs = 1;
  const int counts[] = {4, 4, 4, 3, 3, 2, 0};
  fingers = toy > 0.4f ? counts[3 + random.below(4)] : counts[random.below(std::size(counts))];
  tail = 0.0f;
  tail_thickness = random.uniform(0.4f, 1.2f);
  head.radius = size * random.uniform(0.1f, 0.125f) * (1.0f + 1.4f * toy);
  head.width = random.uniform(0.78f, 1.0f);
  head.snout = random.below(3) == 0 ? random.uniform(0.3f, 0.9f) : random.uniform(0.12f, 0.2f);
  head.snout_width = random.uniform(0.45f, 0.6f);
  head.eyes = random.below(2) == 0 ? random.uniform(0.15f, 0.3f) : 0.0f;
  head.ears = random.below(2) == 0 ? 0.0f : random.below(3) == 0 ? random.uniform(1.0f, 2.2f) : random.uniform(0.35f, 0.8f);
  head.ear_spread = random.uniform(0.0f, 1.0f);
  head.horns = random.below(6) == 0 ? random.uniform(0.5f, 1.3f) : 0.0f;
  outfit = Outfit(random);
  head.headgear = outfit.headgear;
}

Body make_biped(const BipedShape& shape, const Habits& habits) { return BipedMaker(shape, habits).make(); }

Body make_biped(Random& random) {
  BipedShape shape(random);
  if (random.below(6) == 0) shape.tail = random.uniform(0.5f, 1.2f);
  return make_biped(shape, Habits(random));
}

}  // namespace osteon::synth
