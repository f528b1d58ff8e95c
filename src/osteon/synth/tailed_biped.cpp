// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "osteon/synth/biped.h"
#include "osteon/synth/chain.h"
#include "osteon/synth/creatures.h"

namespace osteon::synth {
namespace {

// A trunk that leans forward over two bent legs, balanced by the tail. In metres; a small dinosaur, 1 m at the hips, where a factor is 1.
struct Proportions {
  float size, build, pitch, legs, arms, neck, tail, tail_girth;  // factors; pitch of the trunk above level, radians
  int claws;                                                     // of a hand and a foot
  HeadShape head;

  explicit Proportions(Random& random) {
    size = random.uniform(0.4f, 2.5f);
    build = random.uniform(0.7f, 1.4f);
    pitch = random.uniform(0.05f, 1.1f);
    legs = random.uniform(0.75f, 1.15f);
    arms = random.uniform(0.6f, 1.5f);
    neck = random.uniform(0.6f, 1.8f);
    tail = random.uniform(0.7f, 1.4f);
    tail_girth = random.uniform(0.7f, 1.2f);
    claws = 1 + static_cast<int>(random.below(3));
    head.radius = size * random.uniform(0.1f, 0.2f);
    head.width = random.uniform(0.7f, 0.95f);
    head.forward = random.uniform(0.5f, 1.0f);
    head.snout = random.uniform(0.5f, 1.7f);
    head.snout_width = random.uniform(0.45f, 0.65f);
    head.eyes = random.below(2) == 0 ? random.uniform(0.15f, 0.28f) : 0.0f;
    head.ears = random.below(3) == 0 ? random.uniform(0.8f, 2.2f) : 0.0f;
    head.horns = random.below(5) == 0 ? random.uniform(0.5f, 1.2f) : 0.0f;
  }
};

class TailedMaker {
 public:
  TailedMaker(const Proportions& proportions, const Habits& habits)
      : p_(proportions), habits_(habits), s_(proportions.size), b_(proportions.size * proportions.build) {}

  Body make() {
    add_trunk();
    add_tail();
    add_leg();
    add_arm();
    return std::move(body_);
  }

 private:
  float hip_height() const { return std::max(0.95f * p_.legs * s_, 0.22f * b_ + 0.45f * s_); }
  Vec3f along(float t) const { return {0, hip_height() + 0.75f * s_ * t * std::sin(p_.pitch), 0.75f * s_ * t * std::cos(p_.pitch)}; }

  void add_trunk() {
    const std::vector<ChainPoint> shape{
        {"", along(-0.1f), 0.17f * b_}, {"", along(0.15f), 0.19f * b_}, {"", along(0.5f), 0.19f * b_}, {"", along(0.85f), 0.14f * b_}};
    auto points = jointed(shape, "Spine", habits_.spine + 1);
    points.front() = {"Hips", along(0.0f), 0.18f * b_};
    const auto spine = add_chain(body_, std::nullopt, Rows::Single, points, 0.6f, {{}, 0, 0, Vec3f::UnitX(), 0.85f});
    body_.clothe(spine.front(), {{along(-0.1f), along(0.0f)}, 0.16f * b_, 0.18f * b_, Vec3f::UnitX(), 0.85f}, 0.1f * b_);
    hips_ = spine.front();
    chest_ = spine.back();
    const Vec3f base = along(0.92f), bend = base + 0.16f * p_.neck * s_ * Vec3f(0, 0.55f, 0.8f).normalized(),
                top = bend + 0.14f * p_.neck * s_ * Vec3f(0, 1.0f, 0.25f).normalized();
    const float wide = std::min(0.11f * b_, 0.8f * p_.head.radius);
    const auto neck =
        add_chain(body_, chest_, Rows::Single,
                  jointed({{"", base, 0.12f * b_}, {"", bend, 1.05f * wide}, {"", top, 0.9f * wide}}, "Neck", habits_.neck), 0.8f);
    add_head(body_, neck.empty() ? chest_ : neck.back(), top, p_.head, habits_);
  }

  void add_tail() {
    std::vector<ChainPoint> shape;
    const float length = 1.1f * p_.tail * s_, fall = 0.9f * std::sin(p_.pitch);
    const Vec3f base = along(-0.12f);
    for (int i = 0; i <= 6; ++i) {
      const float t = static_cast<float>(i) / 6.0f, r = 0.14f * p_.tail_girth * b_ * (1.0f - 0.85f * t);
      shape.push_back(
          {"", {0, std::max(base.y() - length * fall * (t - 0.3f * t * t), r), base.z() - length * (0.6f * t + 0.3f * t * t)}, r});
    }
    auto points = jointed(shape, "Tail", habits_.tail);
    points.back().name = joint_if(habits_.ends, "TailEnd");
    add_chain(body_, hips_, Rows::Single, points, 0.7f);
  }

  void add_leg() {
    const float y = hip_height(), x = 0.14f * b_, out = x + 0.02f * b_;
    const Vec3f ankle(out, 0.09f * s_, -0.05f * s_), ball(out, 0.045f * s_, 0.05f * s_);
    const auto leg = add_chain(body_, hips_, Rows::Paired,
                               {{"UpLeg", {x, y - 0.02f * s_, 0.02f * s_}, 0.13f * b_},
                                {joint_if(habits_.knees, "Leg"), {out, 0.55f * y, 0.16f * s_}, 0.085f * b_},
                                {joint_if(habits_.ankles, "Foot"), {out, 0.28f * y, -0.12f * s_}, 0.05f * b_},
                                {joint_if(habits_.toes, "Toes"), ankle + Vec3f(0, -0.02f, 0.04f) * s_, 0.048f * b_}},
                               0.8f);
    for (int c = 0; c < p_.claws; ++c) {
      const float side = static_cast<float>(c) - 0.5f * static_cast<float>(p_.claws - 1);
      const float r = (p_.claws == 1 ? 0.055f : 0.038f) * s_;
      add_chain(body_, leg.back(), Rows::Paired,
                {{"", ankle + Vec3f(0, -0.03f, 0.03f) * s_, r}, {"", ball + Vec3f(0.07f * side, 0, 0.11f) * s_, 0.75f * r}}, 0.4f);
    }
  }

  void add_arm() {
    const Vec3f shoulder = along(0.78f) + Vec3f(0.12f * b_, -0.05f * b_, 0.02f * s_);
    const float reach = 0.17f * p_.arms * s_;
    const Vec3f elbow = shoulder + reach * Vec3f(0.35f, -0.85f, -0.15f).normalized(),
                wrist = elbow + reach * Vec3f(0.1f, -0.45f, 0.85f).normalized();
    const Vec3f tip = wrist + 0.5f * reach * Vec3f(0, -0.5f, 0.85f);
    const float r = 0.045f * b_;
    const auto arm = add_chain(body_, chest_, Rows::Paired,
                               {{"Arm", shoulder, 1.2f * r},
                                {joint_if(habits_.knees, "ForeArm"), elbow, 0.85f * r},
                                {joint_if(habits_.ankles, "Hand"), wrist, 0.7f * r},
                                {"", tip, 0.8f * r}},
                               0.7f);
    if (p_.claws < 2) return;
    for (const float side : {-0.35f, 0.35f}) {
      const std::string name = side < 0 ? "FingerIn" : "FingerOut";
      add_chain(body_, arm.back(), Rows::Paired,
                jointed({{"", tip, 0.75f * r}, {"", tip + 0.45f * reach * Vec3f(side, -0.5f, 0.7f), 0.6f * r}}, name,
                        std::min(habits_.phalanges, 2)),
                0.3f);
    }
  }

  const Proportions& p_;
  const Habits& habits_;
  float s_, b_;  // metres per metre of the small dinosaur: lengths, thicknesses
  Body body_;
  JointId hips_{}, chest_{};
};

}  // namespace

Body make_tailed_biped(Random& random) {
  if (random.below(3) == 0) {  // upright, as a lizard man
    BipedShape shape(random);
    shape.tail = random.uniform(0.9f, 1.6f);
    shape.tail_thickness = random.uniform(1.0f, 1.7f);
    shape.head.snout = random.uniform(0.6f, 1.3f);
    return make_biped(shape, Habits(random));
  }
  const Proportions proportions(random);
  const Habits habits(random);
  return TailedMaker(proportions, habits).make();
}

}  // namespace osteon::synth
