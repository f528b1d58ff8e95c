// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "osteon/synth/chain.h"
#include "osteon/synth/creatures.h"
#include "osteon/synth/habits.h"
#include "osteon/synth/pieces.h"

namespace osteon::synth {
namespace {

// In metres; a trout of 0.4 m where a factor is 1.
struct Proportions {
  float size, depth, width, belly, snout, fins, tail, forked;  // factors; width by depth; belly: where the body is thickest, 0 .. 1
  float back_fin, belly_fin, eyes;                             // factors; 0: none
  bool whale;                                                  // the tail lies flat
  int joints;                                                  // along the body
  bool jointed_fins, rooted_inside;                            // a root of its own in the middle, between head and tail

  explicit Proportions(Random& random) {
    size = random.uniform(0.5f, 6.0f);
    depth = random.below(3) == 0 ? random.uniform(1.4f, 2.6f) : random.uniform(0.7f, 1.4f);
    width = random.uniform(0.35f, 1.0f);
    belly = random.uniform(0.2f, 0.5f);
    snout = random.uniform(0.15f, 0.6f);
    fins = random.uniform(0.7f, 1.8f);
    tail = random.uniform(0.6f, 1.6f);
    forked = random.uniform(0.3f, 1.2f);
    back_fin = random.below(4) == 0 ? 0.0f : random.uniform(0.7f, 1.8f);
    belly_fin = random.below(2) == 0 ? 0.0f : random.uniform(0.6f, 1.2f);
    eyes = random.below(2) == 0 ? 0.0f : random.uniform(0.15f, 0.35f);
    whale = random.below(6) == 0;
    joints = 2 + static_cast<int>(random.below(5));
    jointed_fins = random.below(2) == 0;
    rooted_inside = random.below(3) == 0;
  }
};

class FishMaker {
 public:
  FishMaker(const Proportions& proportions, const Habits& habits) : p_(proportions), habits_(habits), s_(proportions.size) {}

  Body make() {
    add_trunk();
    add_face();
    add_tail();
    add_side_fin();
    if (p_.back_fin > 0.0f) add_middle_fin("FinBack", 1.0f, p_.back_fin);
    if (p_.belly_fin > 0.0f) add_middle_fin("FinBelly", -1.0f, p_.belly_fin);
    return std::move(body_);
  }

 private:
  // t is 0 at the nose .. 1 at the root of the tail.
  Vec3f on_axis(float t) const { return {0, 0.12f * p_.depth * s_, (0.2f - 0.44f * t) * s_}; }
  // Half the height of the body: rises to the belly, falls to the tail.
  float radius(float t) const {
    const float front = p_.snout + (1.0f - p_.snout) * std::sin(1.57f * std::min(t / p_.belly, 1.0f));
    const float back = t < p_.belly ? 1.0f : std::pow(std::cos(1.57f * (t - p_.belly) / (1.0f - p_.belly)), 0.8f);
    return (0.045f * front * back + 0.011f) * p_.depth * s_;
  }

  // The first joint holds the head; the others follow to the tail. Or the root stands in the middle and the head looks forward from it.
  void add_trunk() {
    constexpr int kSteps = 8;
    const RoundCone narrow{{}, 0, 0, Vec3f::UnitX(), p_.width};
    const float root = p_.rooted_inside ? 0.42f : 0.12f;
    std::vector<ChainPoint> front, back;
    for (int i = 0; i <= kSteps; ++i) {
      const float t = static_cast<float>(i) / kSteps;
      const float f = root * (1.0f - t), b = root + (1.0f - root) * t;
      front.push_back({"", on_axis(f), radius(f)});
      back.push_back({"", on_axis(b), radius(b)});
    }
    auto points = jointed(back, "Spine", p_.joints);
    points.front().name = "Root";
    spine_ = add_chain(body_, std::nullopt, Rows::Single, points, 0.9f, narrow);
    const auto head = add_chain(body_, spine_.front(), Rows::Single, jointed(front, "Head", p_.rooted_inside ? 1 : 0), 0.9f, narrow);
    head_ = head.empty() ? spine_.front() : head.front();
  }

  void add_face() {
    const float nose = radius(0.0f);
    if (habits_.jaw)
      add_chain(
          body_, head_, Rows::Single,
          {{"Jaw", on_axis(0.07f) - Vec3f(0, 0.5f * nose, 0), 0.6f * nose}, {"", on_axis(-0.03f) - Vec3f(0, 0.7f * nose, 0), 0.4f * nose}},
          0.9f, {{}, 0, 0, Vec3f::UnitX(), p_.width});
    if (p_.eyes == 0.0f) return;
    const float r = radius(0.08f);
    const Vec3f at = on_axis(0.08f) + Vec3f(0.85f * p_.width * r, 0.3f * r, 0);
    body_.attach(habits_.eyes ? body_.pair("Eye", head_, at) : head_, ball(at, p_.eyes * r));
  }

  void add_tail() {
    const float span = 0.07f * p_.tail * std::sqrt(p_.depth) * s_, r = std::max(0.014f * s_ * std::sqrt(p_.depth), 0.9f * radius(1.0f));
    const Vec3f base = on_axis(0.97f), fork = on_axis(1.08f), back = on_axis(1.0f) - on_axis(1.0f + 0.3f * p_.forked);
    const RoundCone thin{{}, 0, 0, p_.whale ? Vec3f::UnitY() : Vec3f::UnitX(), 0.4f};
    const JointId tail = add_chain(body_, spine_.back(), Rows::Single, {{"Tail", base, r}, {"", fork, r}}, 0.9f, thin)[0];
    if (p_.whale) {
      add_chain(body_, tail, Rows::Paired,
                {{joint_if(p_.jointed_fins, "Fluke"), fork + Vec3f(0.3f * r, 0, 0), r}, {"", fork + Vec3f(span, 0, 0) - back, 0.6f * r}},
                1.0f, thin);
      return;
    }
    for (const auto& [name, up] : {std::pair("TailUpper", 1.0f), std::pair("TailLower", -1.0f)})
      add_chain(body_, tail, Rows::Single,
                {{joint_if(p_.jointed_fins && habits_.toes, name), fork, r}, {"", fork + Vec3f(0, up * span, 0) - back, 0.6f * r}}, 1.0f,
                thin);
  }

  JointId nearest_spine(float t) const {
    return *std::min_element(spine_.begin(), spine_.end(), [&](JointId a, JointId b) {
      return std::abs(body_.at(a).z() - on_axis(t).z()) < std::abs(body_.at(b).z() - on_axis(t).z());
    });
  }

  void add_middle_fin(const std::string& name, float up, float size) {
    const float t = 0.5f, r = 0.018f * s_ * size, high = 0.035f * s_ * size;
    const Vec3f crest = on_axis(t) + Vec3f(0, up * 0.85f * radius(t), 0);
    add_chain(body_, nearest_spine(t), Rows::Single,
              {{joint_if(p_.jointed_fins, name), crest, 1.4f * r},
               {"", crest + Vec3f(0, 0.6f * up * high, -0.5f * high), r},
               {"", crest + Vec3f(0, up * high, -1.1f * high), 0.6f * r}},
              0.9f, {{}, 0, 0, Vec3f::UnitX(), 0.35f});
  }

  void add_side_fin() {
    const float t = 0.32f, r = 0.018f * p_.fins * s_;
    const Vec3f side = on_axis(t) + Vec3f(0.75f * p_.width * radius(t), -0.3f * radius(t), 0);
    const Vec3f out = Vec3f(0.045f, -0.018f, -0.035f) * p_.fins * s_;
    add_chain(body_, nearest_spine(t), Rows::Paired,
              {{joint_if(p_.jointed_fins, "Fin"), side, r},
               {joint_if(p_.jointed_fins && habits_.toes, "Fin1"), side + out, 0.95f * r},
               {joint_if(p_.jointed_fins && habits_.ends, "FinEnd"), side + 1.8f * out, 0.6f * r}},
              0.8f, {{}, 0, 0, Vec3f(0.35f, 0.9f, 0.0f).normalized(), 0.35f});
  }

  const Proportions& p_;
  const Habits& habits_;
  float s_;  // metres per metre of the trout
  Body body_;
  std::vector<JointId> spine_;
  JointId head_{};
};

}  // namespace

Body make_fish(Random& random) {
  const Proportions proportions(random);
  const Habits habits(random);
  return FishMaker(proportions, habits).make();
}

}  // namespace osteon::synth
