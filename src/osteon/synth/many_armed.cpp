// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "osteon/synth/biped.h"
#include "osteon/synth/chain.h"
#include "osteon/synth/creatures.h"

namespace osteon::synth {
namespace {

// In metres; an octopus of 0.8 m where a factor is 1.
struct Octopus {
  float size, head, length, girth, droop;  // factors; droop: of the arms, 0 flat .. 1 standing on their tips
  int pairs, joints;                       // of arms; along each arm
  float eyes;                              // radii of the head

  explicit Octopus(Random& random) {
    size = random.uniform(0.4f, 2.0f);
    head = random.uniform(0.8f, 1.6f);
    length = random.uniform(0.6f, 1.3f);
    girth = random.uniform(0.8f, 1.4f);
    droop = random.uniform(0.2f, 1.0f);
    pairs = 3 + static_cast<int>(random.below(2));
    joints = 2 + static_cast<int>(random.below(4));
    eyes = random.below(3) == 0 ? 0.0f : random.uniform(0.15f, 0.35f);
  }
};

// A head on a ring of arms.
Body make_octopus(const Octopus& p, const Habits& habits) {
  Body body;
  const float s = p.size, height = 0.25f * s * p.droop + 0.08f * s, r = 0.12f * s * p.head;
  const JointId root = body.joint("Body", std::nullopt, {0, height, 0});
  body.clothe(root, {{Vec3f(0, height, 0), Vec3f(0, height + 0.06f * s, 0)}, 0.1f * s, 0.085f * s}, 0.04f * s);
  const HeadShape head{.radius = r, .width = 1.0f, .eyes = p.eyes};
  add_head(body, root, {0, height + 0.1f * s, 0}, head, habits);
  for (int pair = 0; pair < p.pairs; ++pair) {
    const float angle = std::numbers::pi_v<float> * (static_cast<float>(pair) + 0.5f) / static_cast<float>(p.pairs);  // from the front
    const Vec3f out(std::sin(angle), 0, std::cos(angle));
    std::vector<ChainPoint> shape;
    for (int i = 0; i <= 8; ++i) {
      const float t = static_cast<float>(i) / 8.0f, radius = 0.036f * p.girth * s * (1.0f - 0.7f * t);
      const float y = std::max(height * (1.0f - 1.6f * t * (1.0f - 0.3f * t)), radius);
      shape.push_back({"", Vec3f(0, y, 0) + out * s * (0.07f + 0.5f * p.length * t), radius});
    }
    const std::string name = "Tentacle" + std::string(1, static_cast<char>('A' + pair));
    auto points = jointed(shape, name, p.joints);
    points.back().name = joint_if(habits.ends, name + "End");
    add_chain(body, root, Rows::Paired, points, 0.5f);
  }
  return body;
}

}  // namespace

Body make_many_armed(Random& random) {
  if (random.below(2) == 0) {
    const Octopus octopus(random);
    return make_octopus(octopus, Habits(random));
  }
  BipedShape shape(random);
  shape.arm_pairs = 2 + static_cast<int>(random.below(2));
  shape.torso *= 1.15f;
  shape.arm_angle = random.uniform(0.0f, 0.6f);
  Habits habits(random);
  habits.phalanges = std::min(habits.phalanges, 1);  // or there would be more fingers than all else
  return make_biped(shape, habits);
}

}  // namespace osteon::synth
