// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "osteon/synth/chain.h"
#include "osteon/synth/creatures.h"
#include "osteon/synth/head.h"
#include "osteon/synth/wing.h"

namespace osteon::synth {
namespace {

// In metres; lengths of a crow where a factor is 1.
struct Proportions {
  float size, build, legs, feet, neck, tail, pitch;  // factors; pitch of the trunk above level, radians
  bool folded;                                       // wings at the flanks, as on a hen
  int wing_joints;
  WingShape wings;
  HeadShape head;

  explicit Proportions(Random& random) {
    const float toy = std::max(random.uniform(-1.0f, 1.0f), 0.0f);  // 0: as in nature .. 1: a chick
    size = random.uniform(0.5f, 4.0f);
    build = random.uniform(0.85f, 1.6f) * (1.0f + 0.4f * toy);
    legs = (random.below(4) == 0 ? random.uniform(1.8f, 3.5f) : random.uniform(0.6f, 1.6f)) * (1.0f - 0.3f * toy);
    feet = random.uniform(0.9f, 1.5f);
    neck = (random.below(4) == 0 ? random.uniform(1.8f, 4.0f) : random.uniform(0.4f, 1.4f)) * (1.0f - 0.5f * toy);
    tail = random.uniform(0.5f, 1.6f);
    pitch = random.uniform(0.0f, 0.9f);
    folded = random.below(3) == 0;
    wing_joints = 1 + static_cast<int>(random.below(folded ? 2 : 4));
    wings.span = random.uniform(0.28f, 0.6f) * (1.0f - 0.4f * toy);
    wings.chord = random.uniform(0.22f, 0.4f);
    wings.rise = random.uniform(-0.1f, 0.5f);
    wings.sweep = random.uniform(0.0f, 0.5f);
    head.radius = size * random.uniform(0.032f, 0.05f) * (1.0f + toy);
    head.width = random.uniform(0.85f, 1.0f);
    head.forward = random.uniform(0.2f, 0.6f);
    head.snout = random.uniform(0.5f, 2.4f);
    head.snout_width = random.uniform(0.22f, 0.4f);
    head.eyes = random.below(2) == 0 ? random.uniform(0.18f, 0.35f) : 0.0f;
  }
};

class BirdMaker {
 public:
  BirdMaker(const Proportions& proportions, const Habits& habits)
      : p_(proportions), habits_(habits), s_(proportions.size), b_(proportions.size * proportions.build) {}

  Body make() {
    add_trunk();
    add_neck_and_head();
    add_tail();
    if (p_.folded)
      add_folded_wing();
    else
      add_spread_wings();
    add_leg();
    return std::move(body_);
  }

 private:
  float height() const { return 0.08f * p_.legs * s_ + 0.06f * b_; }
  // From the hips (0) to the breast (1).
  Vec3f along(float t) const { return {0, height() + 0.13f * s_ * t * std::sin(p_.pitch), 0.13f * s_ * (t - 0.45f) * std::cos(p_.pitch)}; }

  void add_trunk() {
    auto points = jointed(
        {{"", along(0.0f), 0.052f * b_}, {"", along(0.45f), 0.066f * b_}, {"", along(0.9f), 0.06f * b_}, {"", along(1.15f), 0.045f * b_}},
        "Spine", std::min(habits_.spine, 3));
    points.front().name = "Hips";
    const auto spine = add_chain(body_, std::nullopt, Rows::Single, points, 0.9f);
    hips_ = spine.front();
    chest_ = spine.back();
  }

  void add_neck_and_head() {
    const Vec3f base = along(1.05f) + Vec3f(0, 0.02f * b_, 0),
                top = base + Vec3f(0, 0.1f, 0.035f) * p_.neck * s_ + Vec3f(0, 0.02f * b_, 0.01f * b_);
    const float thick = 0.04f * b_, thin = std::min(0.026f * b_, 0.8f * p_.head.radius);
    const int joints = p_.neck > 1.5f ? 2 + habits_.neck : habits_.neck;
    const auto neck =
        add_chain(body_, chest_, Rows::Single,
                  jointed({{"", base, thick}, {"", 0.5f * (base + top), 0.5f * (thick + thin)}, {"", top, thin}}, "Neck", joints), 0.9f);
    add_head(body_, neck.empty() ? chest_ : neck.back(), top, p_.head, habits_);
  }

  void add_tail() {
    const Vec3f base = along(-0.25f), way = Vec3f(0, -0.3f * std::sin(p_.pitch) - 0.1f, -1.0f).normalized() * 0.14f * p_.tail * s_;
    auto points =
        jointed({{"", base, 0.036f * b_}, {"", base + 0.5f * way, 0.038f * b_}, {"", base + way, 0.04f * b_}}, "Tail", habits_.tail / 2);
    points.back().name = joint_if(habits_.ends, "TailEnd");
    add_chain(body_, hips_, Rows::Single, points, 0.7f, {{}, 0, 0, Vec3f::UnitY(), 0.35f});
  }

  void add_spread_wings() {
    WingShape wings = p_.wings;
    wings.joints = p_.wing_joints;
    wings.span *= s_;
    wings.shoulder = along(0.85f) + Vec3f(0.045f * b_, 0.02f * b_, 0.0f);
    add_wings(body_, chest_, wings, habits_);
  }

  void add_folded_wing() {
    const Vec3f shoulder = along(0.9f) + Vec3f(0.06f * b_, 0.015f * b_, 0), tip = along(-0.35f) + Vec3f(0.068f * b_, 0.01f * b_, 0);
    const Vec3f middle = 0.5f * (shoulder + tip) + Vec3f(0.012f * b_, 0, 0);
    add_chain(body_, chest_, Rows::Paired,
              jointed({{"", shoulder, 0.03f * b_}, {"", middle, 0.042f * b_}, {"", tip, 0.018f * b_}}, "Wing", p_.wing_joints), 0.4f,
              {{}, 0, 0, Vec3f::UnitX(), 0.4f});
  }

  void add_leg() {
    const float x = 0.036f * b_, hip = along(0.2f).y() - 0.02f * b_, z = along(0.2f).z(), r = 0.012f * std::sqrt(p_.build) * s_;
    const Vec3f ankle(x, 0.02f * s_, z - 0.005f * s_);
    const auto leg = add_chain(body_, hips_, Rows::Paired,
                               {{"UpLeg", {x, hip, z}, 0.034f * b_},
                                {joint_if(habits_.ankles, "Leg"), {x, 0.02f * s_ + 0.55f * (hip - 0.02f * s_), z + 0.012f * s_}, 1.3f * r},
                                {joint_if(habits_.toes, "Foot"), ankle, r}},
                               0.8f);
    const JointId foot = leg.back();
    body_.clothe(foot, {{ankle, ankle + Vec3f(0, -0.008f, -0.03f) * p_.feet * s_}, 1.1f * r, 0.8f * r}, 0.008f * s_);
    for (const int toe : {-1, 0, 1}) {
      const Vec3f way = Vec3f(0.55f * static_cast<float>(toe), -0.12f, 1.0f).normalized();
      const std::string name = toe < 0 ? "ToeIn" : toe > 0 ? "ToeOut" : "Toe";
      add_chain(body_, foot, Rows::Paired,
                {{joint_if(habits_.toes && (toe == 0 || habits_.phalanges > 2), name), ankle + 0.008f * s_ * way, 1.1f * r},
                 {"", ankle + 0.055f * p_.feet * s_ * way, 0.85f * r}},
                0.5f);
    }
  }

  const Proportions& p_;
  const Habits& habits_;
  float s_, b_;  // metres per metre of the crow: lengths, thicknesses
  Body body_;
  JointId hips_{}, chest_{};
};

}  // namespace

Body make_bird(Random& random) {
  const Proportions proportions(random);
  const Habits habits(random);
  return BirdMaker(proportions, habits).make();
}

}  // namespace osteon::synth
