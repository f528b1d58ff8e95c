// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "osteon/synth/accessories.h"
#include "osteon/synth/chain.h"
#include "osteon/synth/creatures.h"
#include "osteon/synth/habits.h"
#include "osteon/synth/pieces.h"

namespace osteon::synth {
namespace {

constexpr float kFlatness = 0.88f;  // from front to back

// A monster that is all head, about 1 m high where a factor is 1.
struct Proportions {
  float size, width, taper, belly;  // of the body by its height: width of the middle, top by bottom, how round
  float eyes, horns, ears;          // radii of the body; 0: none
  float arms, legs, tail, wings;    // 0: none
  int levels;                       // joints up the body
  Headgear headgear;
  bool jointed_arms, jointed_legs, jointed_face, cyclops;

  explicit Proportions(Random& random) {
    const auto some = [&](float chance, float low, float high) { return random.uniform() < chance ? random.uniform(low, high) : 0.0f; };
    size = random.uniform(0.6f, 1.8f);
    width = random.uniform(0.28f, 0.5f);
    taper = random.uniform(0.5f, 1.1f);
    belly = random.uniform(0.0f, 0.25f);
    eyes = some(0.8f, 0.15f, 0.36f);
    horns = some(0.35f, 0.3f, 0.8f);
    ears = some(0.35f, 0.3f, 1.0f);
    arms = some(0.6f, 0.5f, 1.2f);
    legs = some(0.6f, 0.3f, 1.2f);
    tail = some(0.25f, 0.4f, 1.0f);
    wings = some(0.2f, 0.6f, 1.2f);
    levels = 2 + static_cast<int>(random.below(3));
    jointed_arms = random.below(2) == 0;
    jointed_legs = random.below(2) == 0;
    jointed_face = random.below(3) == 0;
    cyclops = random.below(4) == 0;
    headgear = horns == 0.0f && ears == 0.0f && random.below(2) == 0 ? Outfit(random).headgear : Headgear::None;
  }
};

class BlobMaker {
 public:
  BlobMaker(const Proportions& proportions, const Habits& habits)
      : p_(proportions), habits_(habits), s_(proportions.size), r_(proportions.width * proportions.size) {}

  Body make() {
    add_trunk();
    add_face();
    if (p_.headgear != Headgear::None) add_headgear();
    if (p_.arms > 0.0f) add_arm();
    if (p_.legs > 0.0f) add_leg();
    if (p_.tail > 0.0f) add_tail();
    if (p_.wings > 0.0f) add_wing();
    return std::move(body_);
  }

 private:
  // Heights t are over the underside, 0 .. 1.
  float height(float t) const { return 0.7f * p_.legs * r_ + t * s_; }
  // The body is the hull of balls on its axis.
  float radius(float t) const { return r_ * (1.0f + (p_.taper - 1.0f) * t + p_.belly * (4.0f * t * (1.0f - t) - 1.0f)); }
  float low() const { return height(0.0f) + radius(0.0f); }
  float high() const { return std::max(height(1.0f) - radius(1.0f), low() + 0.05f * s_); }

  // A stack of joints from the underside up: what is called the head is the upper part of the same lump.
  void add_trunk() {
    std::vector<ChainPoint> shape{{"", {0, height(0.0f) + 0.05f * s_, 0}, 0.04f * s_}};
    for (int i = 0; i <= 6; ++i) {
      const float t = static_cast<float>(i) / 6.0f;
      shape.push_back({"", {0, low() + t * (high() - low()), 0}, radius(t)});
    }
    auto points = jointed(shape, "Head", p_.levels);
    points.front().name = "Body";
    points.back().name = joint_if(habits_.ends, "HeadEnd");
    trunk_ = add_chain(body_, std::nullopt, Rows::Single, points, 0.5f, {{}, 0, 0, Vec3f::UnitZ(), kFlatness});
    head_ = habits_.ends ? trunk_[trunk_.size() - 2] : trunk_.back();
  }

  // A point near the skin at a height t, `turn` radians from the front to the left, at `depth` of the way out from the axis.
  Vec3f on_skin(float t, float turn, float depth) const {
    const float y = height(t), beyond = std::max({low() - y, y - high(), 0.0f});
    const float along = std::clamp((y - low()) / (high() - low()), 0.0f, 1.0f), r = radius(along);
    const float out = depth * std::sqrt(std::max(r * r - beyond * beyond, 0.01f * r * r));
    return {out * std::sin(turn), y, kFlatness * out * std::cos(turn)};
  }

  void add_face() {
    const float r = p_.eyes * r_;
    if (r > 0.0f && p_.cyclops) {
      const Vec3f at = on_skin(0.68f, 0.0f, 0.94f);
      body_.attach(p_.jointed_face ? body_.joint("Eye", head_, {0, at.y(), at.z()}) : head_, ball({0, at.y(), at.z()}, 1.3f * r),
                   Copies::One);
    } else if (r > 0.0f) {
      const Vec3f at = on_skin(0.68f, 0.5f, 0.94f);
      body_.attach(p_.jointed_face ? body_.pair("Eye", head_, at) : head_, ball(at, r));
    }
    const auto crown = [&](float length, float thickness, float spread) {
      const Vec3f base = on_skin(0.85f, 1.4f, 0.8f), way = Vec3f(spread, 1, 0).normalized() * length * r_;
      return std::vector<ChainPoint>{
          {"", base, thickness * r_}, {"", base + 0.6f * way, 0.8f * thickness * r_}, {"", base + way, 0.3f * thickness * r_}};
    };
    if (p_.ears > 0.0f)
      add_chain(body_, head_, Rows::Paired, jointed(crown(p_.ears + 0.3f, 0.25f, 0.5f), "Ear", p_.jointed_face ? 1 : 0), 0.5f,
                {{}, 0, 0, Vec3f::UnitZ(), 0.6f});
    else if (p_.horns > 0.0f) {
      std::vector<Ring> rings;
      for (const ChainPoint& point : crown(p_.horns + 0.4f, 0.18f, 0.7f)) rings.push_back({point.position, point.radius, point.radius});
      body_.attach(head_, tube(rings, 6, Vec3f::UnitZ()));
    }
  }

  void add_headgear() {
    const float r = radius(1.0f);
    body_.attach(head_, headgear(p_.headgear, {0, high(), 0}, Vec3f(r, r, kFlatness * r)), Copies::One);
  }

  void add_arm() {
    const Vec3f shoulder = on_skin(0.45f, 1.57f, 0.85f), hand = shoulder + Vec3f(0.8f, -0.45f, 0.1f) * p_.arms * r_;
    const float r = 0.2f * r_;
    add_chain(body_, trunk_[trunk_.size() / 2], Rows::Paired,
              {{"Arm", shoulder, r}, {joint_if(p_.jointed_arms, "ForeArm"), 0.5f * (shoulder + hand), 0.85f * r}, {"", hand, 1.1f * r}},
              0.4f);
  }

  void add_leg() {
    const float x = 0.48f * r_, r = 0.28f * r_;
    const float foot = 0.2f * r_, knee = std::max(0.5f * height(0.0f), foot);
    add_chain(body_, trunk_.front(), Rows::Paired,
              {{"Leg", Vec3f(x, height(0.14f), 0), r},
               {"", Vec3f(x, knee, 0), 0.8f * r},
               {joint_if(p_.jointed_legs, "Foot"), Vec3f(x, foot, 0), 0.75f * r},
               {"", Vec3f(x, foot, 0.4f * r_), 0.7f * r}},
              0.4f);
  }

  void add_tail() {
    const Vec3f base = on_skin(0.2f, 3.14159265f, 0.8f).cwiseProduct(Vec3f(0, 1, 1)), way = Vec3f(0, 0.4f, -1.0f) * p_.tail * r_;
    add_chain(body_, trunk_.front(), Rows::Single,
              jointed({{"", base, 0.25f * r_}, {"", base + way, 0.12f * r_}}, "Tail", 1 + habits_.tail / 3), 0.5f);
  }

  void add_wing() {
    const Vec3f base = on_skin(0.55f, 2.6f, 0.85f), way = Vec3f(1.0f, 0.4f, -0.25f) * p_.wings * r_;
    const Vec3f across = way.cross(Vec3f(0, 0.6f, -1.0f)).normalized();
    add_chain(
        body_, trunk_[trunk_.size() / 2], Rows::Paired,
        jointed({{"", base, 0.18f * r_}, {"", base + 0.5f * way, 0.42f * r_}, {"", base + way, 0.25f * r_}}, "Wing", 1 + habits_.tail / 3),
        0.3f, {{}, 0, 0, Vec3f(0, across.y(), across.z()).normalized(), 0.3f});
  }

  const Proportions& p_;
  const Habits& habits_;
  float s_, r_;  // height and radius of the body, metres
  Body body_;
  std::vector<JointId> trunk_;
  JointId head_{};
};

}  // namespace

Body make_blob(Random& random) {
  const Proportions proportions(random);
  const Habits habits(random);
  return BlobMaker(proportions, habits).make();
}

}  // namespace osteon::synth
