// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "osteon/synth/creatures.h"
#include "osteon/synth/habits.h"
#include "osteon/synth/pieces.h"

namespace osteon::synth {
namespace {

// In metres; about 1.8 m high where a factor is 1.
struct Proportions {
  float size, legs, arms, torso, head, girth;  // factors
  float arm_angle;                             // below horizontal: 0 arms out .. 1 down
  int corners;                                 // of the beams: 4 boxes .. 14 cylinders
  bool walker;                                 // legs with the knees behind, under a pod; else a man of steel
  bool gun_arms, ball_hinges, antennae;

  explicit Proportions(Random& random) {
    size = random.uniform(0.6f, 2.5f);
    legs = random.uniform(0.6f, 1.3f);
    arms = random.uniform(0.7f, 1.3f);
    torso = random.uniform(0.75f, 1.5f);
    head = random.uniform(0.7f, 1.9f);
    girth = random.uniform(0.6f, 1.4f);
    arm_angle = random.below(2) == 0 ? random.uniform(0.0f, 0.3f) : random.uniform(0.5f, 0.95f);
    const int choices[] = {4, 4, 6, 8, 14};
    corners = choices[random.below(std::size(choices))];
    walker = random.below(3) == 0;
    gun_arms = random.below(2) == 0;
    ball_hinges = random.below(3) != 0;
    antennae = random.below(2) == 0;
  }
};

// Nothing bends: each piece belongs to one joint.
class RobotMaker {
 public:
  RobotMaker(const Proportions& proportions, const Habits& habits) : p_(proportions), habits_(habits), s_(proportions.size) {}

  Body make() {
    if (p_.walker) {
      add_pod();
      add_walking_leg();
      if (p_.gun_arms) add_gun_arm();
    } else {
      add_trunk();
      add_head();
      add_arm();
      add_leg();
    }
    return std::move(body_);
  }

 private:
  // A beam from a to b, a little longer than the bone so that the pieces meet.
  void add_beam(JointId joint, const Vec3f& a, const Vec3f& b, float wide_a, float wide_b, float depth, Copies copies) {
    const Vec3f side = std::abs((b - a).normalized().x()) > 0.7f ? Vec3f::UnitZ() : Vec3f::UnitX();
    body_.attach(joint,
                 tube({{a, wide_a, wide_a * depth},
                       {0.5f * (a + b), 0.5f * (wide_a + wide_b), 0.5f * (wide_a + wide_b) * depth},
                       {b, wide_b, wide_b * depth}},
                      p_.corners, side),
                 copies);
  }
  void add_hinge(JointId joint, float radius, Copies copies) {
    if (p_.ball_hinges)
      body_.attach(joint, ball(body_.at(joint), radius), copies);
    else
      body_.attach(joint,
                   tube({{body_.at(joint) - Vec3f(1.1f * radius, 0, 0), radius, radius},
                         {body_.at(joint) + Vec3f(1.1f * radius, 0, 0), radius, radius}},
                        10, Vec3f::UnitZ()),
                   copies);
  }
  // A limb of the left and right: a hinge at each joint, a beam to the next.
  std::vector<JointId> add_limb(JointId parent, const std::vector<std::pair<std::string, Vec3f>>& points, float wide_a, float wide_b) {
    std::vector<JointId> joints;
    const auto width = [&](std::size_t i) {
      return wide_a + (wide_b - wide_a) * static_cast<float>(i) / static_cast<float>(points.size() - 1);
    };
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      parent = body_.pair(points[i].first, parent, points[i].second);
      const Vec3f step = points[i + 1].second - points[i].second;
      add_hinge(parent, 0.95f * width(i), Copies::Both);
      add_beam(parent, points[i].second + 0.08f * step, points[i + 1].second - 0.04f * step, width(i), width(i + 1), 1.0f, Copies::Both);
      joints.push_back(parent);
    }
    return joints;
  }

  float hip_height() const { return 0.9f * p_.legs * s_; }
  float width() const { return 0.17f * p_.girth * s_; }

  void add_trunk() {
    const float y = hip_height(), top = y + 0.55f * p_.torso * s_, w = width();
    root_ = body_.joint("Hips", std::nullopt, {0, y + 0.04f * s_ * habits_.root, 0});
    add_beam(root_, {0, y - 0.06f * s_, 0}, {0, y + 0.1f * s_, 0}, 0.85f * w, 0.7f * w, 0.75f, Copies::One);
    chest_ = root_;
    const int pieces = 1 + habits_.spine / 2;
    for (int i = 0; i < pieces; ++i) {
      const float from = y + 0.12f * s_, step = (top - from) / static_cast<float>(pieces), low = from + step * static_cast<float>(i);
      const float wide = w * (i + 1 == pieces ? 1.15f : 0.75f);
      chest_ = body_.joint("Spine" + std::to_string(i), chest_, {0, low, 0});
      add_beam(chest_, {0, low - 0.02f * s_, 0}, {0, low + step - 0.03f * s_, 0}, wide, i + 1 == pieces ? 1.2f * w : wide, 0.7f,
               Copies::One);
    }
    top_ = {0, top, 0};
  }

  void add_head() {
    const float r = 0.12f * p_.head * s_;
    JointId parent = chest_;
    Vec3f at = top_;
    if (habits_.neck > 0) {
      parent = body_.joint("Neck", chest_, top_ - Vec3f(0, 0.01f * s_, 0));
      at = top_ + Vec3f(0, 0.08f * s_, 0);
      add_beam(parent, body_.at(parent) - Vec3f(0, 0.03f * s_, 0), at, 0.05f * s_, 0.05f * s_, 1.0f, Copies::One);
    }
    const JointId head = body_.joint("Head", parent, at);
    add_beam(head, at - Vec3f(0, 0.02f * s_, 0), at + Vec3f(0, 1.7f * r, 0), r, 0.9f * r, 1.0f, Copies::One);
    const JointId eye = habits_.eyes ? body_.pair("Eye", head, at + Vec3f(0.4f, 1.0f, 0.85f) * r) : head;
    body_.attach(eye, ball(at + Vec3f(0.4f, 1.0f, 0.9f) * r, 0.2f * r));
    if (p_.antennae) add_beam(head, at + Vec3f(0.5f, 1.6f, 0) * r, at + Vec3f(0.7f, 2.8f, 0) * r, 0.06f * r, 0.04f * r, 1.0f, Copies::Both);
  }

  void add_arm() {
    const float w = width(), r = 0.055f * p_.girth * s_, reach = 0.3f * p_.arms * s_;
    const Vec3f shoulder = top_ + Vec3f(1.2f * w + 1.2f * r, -1.4f * r, 0),
                way = Vec3f(1.0f - p_.arm_angle, -p_.arm_angle, 0.0f).normalized();
    const Vec3f bend = 0.08f * reach * Vec3f::UnitZ(), elbow = shoulder + reach * way, wrist = elbow + reach * way + bend,
                tip = wrist + 0.35f * reach * way;
    JointId parent = chest_;
    if (habits_.clavicles) {
      parent = body_.pair("Shoulder", chest_, top_ + Vec3f(0.5f * w, -1.4f * r, 0));
      add_beam(parent, body_.at(parent), shoulder, 0.8f * r, 0.8f * r, 1.0f, Copies::Both);
    }
    const auto arm = add_limb(parent, {{"Arm", shoulder}, {"ForeArm", elbow}, {"", wrist}}, 1.1f * r, 0.8f * r);
    const JointId hand = body_.pair("Hand", arm.back(), wrist);
    add_beam(hand, wrist - 0.01f * way, wrist + 0.5f * (tip - wrist), 0.9f * r, 1.0f * r, 0.8f, Copies::Both);
    for (const float z : {-0.7f, 0.7f}) {  // grippers
      const Vec3f base = wrist + 0.5f * (tip - wrist) + Vec3f(0, 0, z * r);
      const JointId finger = habits_.phalanges > 0 ? body_.pair(z < 0 ? "FingerBack" : "FingerFront", hand, base) : hand;
      add_beam(finger, base - 0.005f * way, tip + Vec3f(0, 0, 0.6f * z * r), 0.3f * r, 0.2f * r, 1.0f, Copies::Both);
    }
  }

  void add_leg() {
    const float y = hip_height(), r = 0.075f * p_.girth * s_, x = std::max(0.6f * width(), 1.15f * r);
    const Vec3f hip(x, y - 0.05f * s_, 0), knee(x, 0.52f * y, 0.015f * s_), ankle(x, 0.1f * s_, -0.01f * s_);
    const auto leg = add_limb(root_, {{"UpLeg", hip}, {"Leg", knee}, {"", ankle}}, r, 0.85f * r);
    const JointId foot = body_.pair("Foot", leg.back(), ankle);
    add_hinge(foot, 0.8f * r, Copies::Both);
    body_.attach(foot, block({x, 0.04f * s_, 0.045f * s_}, {2.0f * r, 0.08f * s_, 0.26f * s_}));
  }

  void add_pod() {
    const float y = hip_height(), w = 1.5f * width(), h = 0.35f * p_.torso * s_;
    root_ = body_.joint("Hips", std::nullopt, {0, y, 0});
    add_beam(root_, {0, y - 0.1f * s_, 0}, {0, y + 0.06f * s_, 0}, 0.8f * w, 0.8f * w, 0.8f, Copies::One);
    chest_ = body_.joint("Body", root_, {0, y + 0.07f * s_, 0});
    add_beam(chest_, {0, y + 0.06f * s_, 0}, {0, y + 0.07f * s_ + h, 0}, w, 0.85f * w, 1.1f, Copies::One);
    top_ = {0, y + 0.07f * s_ + h, 0};
    body_.attach(chest_, ball({0.4f * w, y + 0.5f * h, 1.05f * w}, 0.18f * w));
    if (p_.antennae) add_head();
  }

  void add_walking_leg() {
    const float y = hip_height(), r = 0.07f * p_.girth * s_, x = 1.25f * width() + 1.5f * r;
    const Vec3f hip(x, y, 0), knee(x, 0.72f * y, 0.22f * s_ * p_.legs), hock(x, 0.42f * y, -0.2f * s_ * p_.legs),
        ankle(x, 0.08f * s_, 0.0f);
    const auto leg = add_limb(root_, {{"UpLeg", hip}, {"Leg", knee}, {"Hock", hock}, {"", ankle}}, r, 0.6f * r);
    const JointId foot = body_.pair("Foot", leg.back(), ankle);
    add_hinge(foot, 0.8f * r, Copies::Both);
    body_.attach(foot, block({x, 0.035f * s_, 0.03f * s_}, {2.4f * r, 0.07f * s_, 0.3f * s_}));
  }

  void add_gun_arm() {
    const float w = 1.5f * width(), r = 0.07f * p_.girth * s_;
    const Vec3f shoulder = top_ + Vec3f(w + 1.2f * r, -0.12f * s_, 0), muzzle = shoulder + Vec3f(0, -0.03f, 0.55f) * s_;
    const JointId arm = body_.pair("Arm", chest_, shoulder);
    add_hinge(arm, 1.2f * r, Copies::Both);
    add_beam(arm, shoulder - Vec3f(0, 0, 0.1f * s_), muzzle, r, 0.7f * r, 1.0f, Copies::Both);
  }

  const Proportions& p_;
  const Habits& habits_;
  float s_;
  Body body_;
  JointId root_{}, chest_{};
  Vec3f top_ = Vec3f::Zero();  // of the trunk
};

}  // namespace

Body make_robot(Random& random) {
  const Proportions proportions(random);
  const Habits habits(random);
  return RobotMaker(proportions, habits).make();
}

}  // namespace osteon::synth
