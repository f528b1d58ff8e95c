// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/wing.h"

#include <cmath>

#include "osteon/synth/chain.h"
#include "osteon/synth/pieces.h"

namespace osteon::synth {
namespace {

// The wing's leading edge: out, up, and first a little forwards.
Vec3f on_edge(const WingShape& shape, float t) {
  const float forward = 0.35f * t * (1.0f - t) - shape.sweep * t * t;
  return shape.shoulder + shape.span * Vec3f(t, shape.rise * t, forward);
}

std::vector<ChainPoint> arm(const WingShape& shape, const Habits& habits, float thickness, float taper) {
  std::vector<ChainPoint> points;
  for (int i = 0; i <= 6; ++i) {
    const float t = static_cast<float>(i) / 6.0f;
    points.push_back({"", on_edge(shape, t), thickness * shape.span * (1.0f - taper * t * t)});
  }
  points = jointed(points, "Wing", shape.joints);
  points.back().name = joint_if(habits.ends, "WingEnd");
  return points;
}

void add_feathered(Body& body, JointId parent, const WingShape& shape, const Habits& habits) {
  auto points = arm(shape, habits, 0.5f * shape.chord, 0.55f);
  const RoundCone flat{{}, 0, 0, Vec3f(-shape.rise, 1, 0).normalized(), 0.28f};
  add_chain(body, parent, Rows::Paired, points, 0.5f, flat);
}

// The web hangs behind the arm; its rear edge is scalloped between the fingers.
void add_webbed(Body& body, JointId parent, const WingShape& shape, const Habits& habits) {
  const JointId first = add_chain(body, parent, Rows::Paired, arm(shape, habits, 0.045f, 0.6f), 0.4f).front();
  std::vector<Ring> rings;
  constexpr int kRings = 12;
  for (int i = 0; i <= kRings; ++i) {
    const float t = static_cast<float>(i) / kRings;
    const float scallop = 0.15f * std::abs(std::sin(9.42f * t));
    const float chord = shape.chord * shape.span * (1.0f - 0.75f * t * t - scallop) + 0.02f * shape.span;
    rings.push_back({on_edge(shape, 0.04f + 0.96f * t) - Vec3f(0, 0, 0.5f * chord), 0.5f * chord, 0.008f * shape.span});
  }
  body.drape(first, tube(rings, 10, Vec3f::UnitZ()));
}

}  // namespace

void add_wings(Body& body, JointId parent, const WingShape& shape, const Habits& habits) {
  if (shape.style == WingStyle::Feathered)
    add_feathered(body, parent, shape, habits);
  else
    add_webbed(body, parent, shape, habits);
}

}  // namespace osteon::synth
