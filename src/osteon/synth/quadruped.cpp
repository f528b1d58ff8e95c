// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/quadruped.h"

#include <algorithm>
#include <cmath>

#include "osteon/synth/chain.h"
#include "osteon/synth/creatures.h"

namespace osteon::synth {
namespace {

class QuadrupedMaker {
 public:
  QuadrupedMaker(const QuadrupedShape& shape, const Habits& habits)
      : p_(shape), habits_(habits), s_(shape.size), b_(shape.size * shape.build), l_(shape.size * shape.build * shape.legs) {}

  Body make() {
    add_trunk();
    add_neck_and_head();
    if (p_.tail > 0.0f) add_tail();
    add_hind_leg();
    add_front_leg();
    if (p_.wings) add_spread_wings();
    return std::move(body_);
  }

 private:
  // The belly stays off the ground however fat the animal.
  float back_height() const { return std::max(0.48f * p_.height * s_, 0.1f * b_ * p_.belly + 0.13f * s_); }
  float along(float z) const { return z * p_.length * s_; }

  void add_trunk() {
    const float y = back_height(), belly = p_.belly;
    const std::vector<ChainPoint> shape{{"", {0, y, along(-0.3f)}, 0.088f * b_},
                                        {"", {0, y, along(-0.2f)}, 0.098f * b_},
                                        {"", {0, y - 0.01f * b_ * belly, along(-0.05f)}, 0.092f * belly * b_},
                                        {"", {0, y - 0.01f * b_ * belly, along(0.08f)}, 0.1f * belly * b_},
                                        {"", {0, y, along(0.2f)}, 0.112f * b_},
                                        {"", {0, y + 0.005f * s_, along(0.28f)}, 0.095f * b_}};
    auto points = jointed(shape, "Spine", habits_.spine + 1);
    points.front().name = "Hips";
    const auto spine = add_chain(body_, std::nullopt, Rows::Single, points, 0.7f, {{}, 0, 0, Vec3f::UnitX(), 0.82f});
    hips_ = spine.front();
    chest_ = spine.back();
  }

  void add_neck_and_head() {
    const Vec3f base(0, back_height() + 0.025f * s_, along(0.28f));
    const Vec3f way = Vec3f(0, 0.2f + 0.8f * p_.neck_rise, 0.85f - 0.55f * p_.neck_rise).normalized();
    const Vec3f top = base + 0.19f * p_.neck * s_ * way;
    const float thin = 0.072f * b_ / std::sqrt(std::max(p_.neck, 0.6f)), thick = 0.08f * b_;
    const auto neck = add_chain(
        body_, chest_, Rows::Single,
        jointed({{"", base, thick}, {"", 0.5f * (base + top), 0.5f * (thick + thin)}, {"", top, thin}}, "Neck", habits_.neck), 0.7f);
    add_head(body_, neck.empty() ? chest_ : neck.back(), top, p_.head, habits_);
  }

  void add_tail() {
    std::vector<ChainPoint> shape;
    const float length = 0.34f * p_.tail * s_, thick = 0.034f * p_.tail_thickness * b_;
    const Vec3f base(0, back_height() + 0.035f * b_, along(-0.3f) - 0.055f * b_);
    for (int i = 0; i <= 6; ++i) {
      const float t = static_cast<float>(i) / 6.0f;
      shape.push_back(
          {"", base + length * Vec3f(0, 0.2f * t + (0.7f * p_.tail_rise - 0.1f) * t * t, -0.9f * t), thick * (1.0f - 0.6f * t)});
      shape.back().position.y() = std::max(shape.back().position.y(), 0.04f * s_);
    }
    auto points = jointed(shape, "Tail", habits_.tail);
    points.back().name = joint_if(habits_.ends, "TailEnd");
    add_chain(body_, hips_, Rows::Single, points, 0.7f);
  }

  void add_hind_leg() {
    const float y = back_height(), x = 0.066f * b_, z = along(-0.27f), out = x + 0.012f * b_;
    add_chain(
        body_, hips_, Rows::Paired,
        {{"UpLeg", {x, y - 0.03f * b_, z}, 0.074f * std::max(b_, l_)},
         {joint_if(habits_.knees, "Leg"), {out, 0.56f * y, z + 0.055f * p_.bend * s_}, 0.045f * l_},
         {joint_if(habits_.ankles, "Foot"), {out, 0.28f * y, z - 0.07f * p_.bend * s_}, 0.03f * l_},
         {joint_if(habits_.toes, "Toes"), {out, 0.034f * s_, z - 0.035f * p_.bend * s_}, 0.031f * l_},
         {joint_if(habits_.toes && habits_.ends, "ToesEnd"), {out, 0.028f * s_, z - 0.035f * p_.bend * s_ + 0.055f * s_}, 0.029f * l_}},
        0.7f);
  }

  void add_front_leg() {
    const float y = back_height(), x = 0.066f * b_, z = along(0.22f), out = x + 0.01f * b_;
    add_chain(body_, chest_, Rows::Paired,
              {{joint_if(habits_.clavicles, "Shoulder"), {x, y + 0.02f * b_, z - 0.02f * s_}, 0.058f * b_},
               {"Arm", {out, 0.78f * y, z + 0.04f * p_.bend * s_}, 0.054f * std::max(b_, l_)},
               {joint_if(habits_.knees, "ForeArm"), {out, 0.52f * y, z - 0.025f * p_.bend * s_}, 0.042f * l_},
               {joint_if(habits_.ankles, "Hand"), {out, 0.2f * y, z}, 0.03f * l_},
               {joint_if(habits_.toes, "Fingers"), {out, 0.034f * s_, z + 0.01f * s_}, 0.031f * l_},
               {joint_if(habits_.toes && habits_.ends, "FingersEnd"), {out, 0.028f * s_, z + 0.06f * s_}, 0.029f * l_}},
              0.7f);
  }

  void add_spread_wings() {
    WingShape wings = *p_.wings;
    wings.span *= s_;
    wings.shoulder = {0.06f * b_, back_height() + 0.07f * b_, along(0.16f)};
    add_wings(body_, chest_, wings, habits_);
  }

  const QuadrupedShape& p_;
  const Habits& habits_;
  float s_, b_, l_;  // metres per metre of the middling dog: lengths, thicknesses, thicknesses of the legs
  Body body_;
  JointId hips_{}, chest_{};
};

}  // namespace

QuadrupedShape::QuadrupedShape(Random& random) {
  const float toy = std::max(random.uniform(-1.0f, 1.0f), 0.0f);  // 0: as in nature .. 1: a plush toy
  size = random.uniform(0.5f, 2.5f);
  length = random.uniform(0.8f, 1.35f) * (1.0f - 0.35f * toy);
  height = random.uniform(0.6f, 1.35f) * (1.0f - 0.3f * toy);
  build = random.uniform(0.7f, 1.5f);
  belly = random.uniform(0.75f, 1.35f);
  legs = random.uniform(0.8f, 1.3f);
  neck = random.below(5) == 0 ? random.uniform(1.5f, 3.0f) : random.uniform(0.5f, 1.4f);
  neck_rise = random.uniform(0.1f, 1.0f);
  bend = random.below(4) == 0 ? 0.2f : random.uniform(0.6f, 1.2f);
  tail = random.below(8) == 0 ? 0.0f : random.uniform(0.3f, 1.8f);
  tail_thickness = random.below(4) == 0 ? random.uniform(1.2f, 2.2f) : random.uniform(0.5f, 1.0f);
  tail_rise = random.uniform(-1.0f, 0.8f);
  head.radius = size * random.uniform(0.06f, 0.085f) * (1.0f + 1.2f * toy);
  head.width = random.uniform(0.75f, 1.0f);
  head.forward = random.uniform(0.7f, 1.0f);
  head.snout = random.uniform(0.3f, 1.5f) * (1.0f - 0.6f * toy);
  head.snout_width = random.uniform(0.4f, 0.65f);
  head.eyes = random.below(2) == 0 ? random.uniform(0.15f, 0.3f) : 0.0f;
  head.ears = random.below(6) == 0 ? 0.0f : random.below(4) == 0 ? random.uniform(1.5f, 2.5f) : random.uniform(0.5f, 1.1f);
  head.ear_spread = random.uniform();
  head.horns = random.below(4) == 0 ? random.uniform(0.6f, 2.0f) : 0.0f;
  head.horn_curl = random.uniform(-1.0f, 1.0f);
  if (random.below(10) == 0) head.headgear = Outfit(random).headgear;
}

Body make_quadruped(const QuadrupedShape& shape, const Habits& habits) { return QuadrupedMaker(shape, habits).make(); }

Body make_quadruped(Random& random) {
  const QuadrupedShape shape(random);
  return make_quadruped(shape, Habits(random));
}

}  // namespace osteon::synth
