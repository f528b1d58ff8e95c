// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "osteon/synth/creatures.h"
#include "osteon/synth/habits.h"
#include "osteon/synth/pieces.h"

namespace osteon::synth {
namespace {

Vec3f uniform(Random& random, const Vec3f& low, const Vec3f& high) {
  const float x = random.uniform(low.x(), high.x()), y = random.uniform(low.y(), high.y()), z = random.uniform(low.z(), high.z());
  return {x, y, z};
}

// Sizes of the boxes, metres.
struct Boxes {
  Vec3f trunk, head, arm, leg, tail;
  float neck;               // length; 0: the head stands on the trunk
  int limb_joints;          // 1, or 2 with elbows and knees
  bool split, ears, wings;  // split: two boxes of trunk

  explicit Boxes(Random& random) {
    limb_joints = random.below(3) == 0 ? 2 : 1;
    split = random.below(4) == 0;
    ears = random.below(2) == 0;
    wings = false;
    neck = 0;
  }
};

class BlockyMaker {
 public:
  BlockyMaker(const Boxes& boxes, const Habits& habits) : p_(boxes), habits_(habits) {}

  Body make_animal() {
    const Vec3f t = p_.trunk, middle(0, p_.leg.y() + 0.48f * t.y(), 0);
    root_ = body_.joint("Body", std::nullopt, middle - Vec3f(0, 0, (0.03f + 0.32f * habits_.root) * t.z()));
    chest_ = root_;
    if (p_.split) {
      chest_ = body_.joint("Chest", root_, middle + Vec3f(0, 0, 0.05f * t.z()));
      add_block(root_, middle - Vec3f(0, 0, 0.25f * t.z()), {0.94f * t.x(), 0.94f * t.y(), 0.52f * t.z()});
      add_block(chest_, middle + Vec3f(0, 0, 0.25f * t.z()), {t.x(), t.y(), 0.5f * t.z()});
    } else {
      add_block(root_, middle, t);
    }
    const float x = 0.5f * (t.x() - p_.leg.x()), z = 0.5f * (t.z() - p_.leg.z()) - 0.02f * t.z();
    add_limb(root_, "BackLeg", {x, p_.leg.y(), -z}, p_.leg, -Vec3f::UnitY());
    add_limb(chest_, "FrontLeg", {x, p_.leg.y(), z}, p_.leg, -Vec3f::UnitY());
    const Vec3f neck = middle + Vec3f(0, 0.4f * t.y(), 0.46f * t.z());
    JointId parent = chest_;
    if (p_.neck > 0.0f) {
      parent = body_.joint("Neck", chest_, neck);
      body_.attach(parent,
                   tube({{neck - Vec3f(0, 0.1f, 0.05f) * t.y(), 0.3f * p_.head.x(), 0.3f * p_.head.x()},
                         {neck + Vec3f(0, 0.8f, 0.3f) * p_.neck, 0.28f * p_.head.x(), 0.28f * p_.head.x()}},
                        4),
                   Copies::One);
    }
    const Vec3f at = neck + Vec3f(0, 0.8f, 0.3f) * p_.neck;
    add_head(parent, at, at + Vec3f(0, 0.15f * p_.head.y(), 0.4f * p_.head.z()), 0.4f);
    if (p_.tail.z() > 0.0f) add_tail(middle + Vec3f(0, 0.4f * t.y(), -0.48f * t.z()));
    return std::move(body_);
  }

  Body make_humanoid() {
    const Vec3f t = p_.trunk;
    const float hip = p_.leg.y(), top = hip + t.y();
    root_ = body_.joint("Body", std::nullopt, {0, hip + (0.05f + 0.4f * habits_.root) * t.y(), 0});
    chest_ = root_;
    if (p_.split) {
      chest_ = body_.joint("Chest", root_, {0, hip + 0.55f * t.y(), 0});
      add_block(root_, {0, hip + 0.25f * t.y(), 0}, {0.9f * t.x(), 0.5f * t.y(), 0.9f * t.z()});
      add_block(chest_, {0, hip + 0.75f * t.y(), 0}, {t.x(), 0.5f * t.y(), t.z()});
    } else {
      add_block(root_, {0, hip + 0.5f * t.y(), 0}, t);
    }
    add_limb(root_, "Leg", {0.5f * t.x() - 0.52f * p_.leg.x(), hip, 0}, p_.leg, -Vec3f::UnitY());
    const Vec3f shoulder(0.51f * t.x() + 0.5f * p_.arm.x(), top - 0.5f * p_.arm.x(), 0);
    if (habits_.clavicles)  // arms out
      add_limb(chest_, "Arm", shoulder - Vec3f(0.5f * p_.arm.x(), 0, 0), p_.arm, Vec3f::UnitX());
    else
      add_limb(chest_, "Arm", shoulder + Vec3f(0, 0.3f * p_.arm.x(), 0), p_.arm, -Vec3f::UnitY());
    add_head(chest_, {0, top, 0}, {0, top + 0.5f * p_.head.y(), 0}, 0.0f);
    return std::move(body_);
  }

 private:
  void add_block(JointId joint, const Vec3f& centre, const Vec3f& size) { body_.attach(joint, block(centre, size), Copies::One); }

  // A beam from its upper end along `way`, of one piece or two. `size`: width, length, depth.
  void add_limb(JointId parent, const std::string& name, const Vec3f& top, const Vec3f& size, const Vec3f& way) {
    const int pieces = p_.limb_joints;
    const Vec3f step = way * (size.y() / static_cast<float>(pieces)), side = way.x() == 0.0f ? Vec3f::UnitX() : Vec3f::UnitY();
    for (int i = 0; i < pieces; ++i) {
      const Vec3f a = top + static_cast<float>(i) * step, b = a + step;
      const float wide = 0.5f * size.x() * (i == 0 ? 1.0f : 0.92f), deep = 0.5f * size.z() * (i == 0 ? 1.0f : 0.92f);
      parent = body_.pair(i == 0 ? name : name + std::to_string(i), parent, a + 0.12f * step);
      body_.attach(parent, tube({{a, wide, deep}, {0.5f * (a + b), wide, deep}, {b, wide, deep}}, 4, side));
    }
  }

  void add_head(JointId parent, const Vec3f& at, const Vec3f& centre, float snout) {
    const Vec3f h = p_.head;
    const JointId head = body_.joint("Head", parent, at + Vec3f(0, 0.03f * h.y(), 0));
    add_block(head, centre, h);
    if (snout > 0.0f) {
      const Vec3f size(0.55f * h.x(), 0.4f * h.y(), snout * h.z());
      const Vec3f at_snout = centre + Vec3f(0, -0.22f * h.y(), 0.5f * (h.z() + size.z()));
      const JointId jaw = habits_.jaw ? body_.joint("Jaw", head, at_snout - Vec3f(0, 0, 0.45f * size.z())) : head;
      add_block(jaw, at_snout, size);
    }
    if (p_.ears) {
      const Vec3f ear(0.22f * h.x(), 0.35f * h.y(), 0.12f * h.z()), on = centre + Vec3f(0.33f * h.x(), 0.5f * h.y() + 0.5f * ear.y(), 0);
      body_.attach(habits_.ears ? body_.pair("Ear", head, on - Vec3f(0, 0.4f * ear.y(), 0)) : head, block(on, ear));
    }
  }

  void add_tail(const Vec3f& at) {
    const int joints = habits_.tail > 4 ? 2 : 1;
    const Vec3f step = Vec3f(0, -0.5f, -0.85f).normalized() * p_.tail.z() / static_cast<float>(joints);
    JointId parent = root_;
    for (int i = 0; i < joints; ++i) {
      const Vec3f a = at + static_cast<float>(i) * step;
      parent = body_.joint("Tail" + std::to_string(i), parent, a + 0.05f * step);
      body_.attach(parent, tube({{a, 0.5f * p_.tail.x(), 0.5f * p_.tail.y()}, {a + step, 0.5f * p_.tail.x(), 0.5f * p_.tail.y()}}, 4),
                   Copies::One);
    }
  }

  const Boxes& p_;
  const Habits& habits_;
  Body body_;
  JointId root_{}, chest_{};
};

}  // namespace

Body make_blocky_animal(Random& random) {
  Boxes boxes(random);
  boxes.trunk = uniform(random, {0.35f, 0.35f, 0.6f}, {0.75f, 0.75f, 1.5f});
  boxes.head = uniform(random, {0.35f, 0.35f, 0.3f}, {0.8f, 0.7f, 0.7f});
  boxes.leg = uniform(random, {0.12f, 0.15f, 0.12f}, {0.28f, 0.8f, 0.28f});
  boxes.leg.x() = std::min(boxes.leg.x(), 0.45f * boxes.trunk.x());
  if (random.below(3) != 0)
    boxes.tail = uniform(random, {0.06f, 0.06f, 0.15f}, {0.2f, 0.2f, 0.7f});
  else
    boxes.tail = Vec3f::Zero();
  boxes.neck = random.below(3) == 0 ? random.uniform(0.2f, 1.0f) : 0.0f;
  return BlockyMaker(boxes, Habits(random)).make_animal();
}

Body make_blocky_humanoid(Random& random) {
  Boxes boxes(random);
  boxes.trunk = uniform(random, {0.35f, 0.45f, 0.2f}, {0.7f, 0.8f, 0.45f});
  boxes.head = uniform(random, {0.35f, 0.35f, 0.35f}, {0.8f, 0.75f, 0.7f});
  boxes.leg = uniform(random, {0.17f, 0.25f, 0.17f}, {0.3f, 0.85f, 0.3f});
  boxes.leg.x() = std::min(boxes.leg.x(), 0.48f * boxes.trunk.x());
  boxes.arm = uniform(random, {0.13f, 0.35f, 0.13f}, {0.28f, 0.8f, 0.28f});
  boxes.arm.y() = std::min(boxes.arm.y(), boxes.trunk.y() + 0.8f * boxes.leg.y());
  return BlockyMaker(boxes, Habits(random)).make_humanoid();
}

}  // namespace osteon::synth
