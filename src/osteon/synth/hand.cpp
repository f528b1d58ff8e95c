// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/hand.h"

#include <algorithm>

#include "osteon/synth/chain.h"

namespace osteon::synth {
namespace {

// `length` of a phalanx and `radius` in metres.
void add_finger(Body& body, JointId hand, const std::string& name, const Vec3f& base, const Vec3f& way, float length, float radius,
                const Habits& habits) {
  auto points =
      jointed({{"", base, radius}, {"", base + 1.2f * length * way, 0.95f * radius}, {"", base + 2.6f * length * way, 0.78f * radius}},
              name, habits.phalanges);
  points.back().name = joint_if(habits.ends && habits.phalanges > 0, name + "End");
  add_chain(body, hand, Rows::Paired, points, 0.5f);
}

}  // namespace

JointId add_hand(Body& body, JointId forearm, const Vec3f& wrist, const Vec3f& along, const HandShape& shape, const Habits& habits) {
  const float s = shape.size;
  const Vec3f front = (Vec3f::UnitZ() - along * along.z()).normalized(), back_of_hand = front.cross(along).normalized();
  const Vec3f knuckles = wrist + 0.085f * s * along;
  const std::string name = shape.name + "Hand";
  const JointId hand = body.pair(name, forearm, wrist);
  body.clothe(hand, {{wrist + 0.02f * s * along, knuckles - 0.018f * s * along}, 0.033f * s, 0.042f * s, back_of_hand, 0.55f}, 0.03f * s);
  const Vec3f thumb_way = (0.75f * along + 0.62f * front).normalized();
  add_finger(body, hand, name + "Thumb", wrist + (0.028f * along + 0.024f * front) * s, thumb_way, 0.03f * s, 0.0135f * s, habits);
  if (shape.fingers == 0) {
    add_finger(body, hand, name + "Mitten", knuckles, along, 0.03f * s, 0.033f * s, habits);
    return hand;
  }
  const char* names[] = {"Index", "Middle", "Ring", "Pinky"};
  const float lengths[] = {0.030f, 0.033f, 0.031f, 0.025f};
  const auto fingers = static_cast<float>(shape.fingers);
  const float spread = 0.078f / fingers, radius = std::min(0.038f / (fingers + 0.2f), 0.0165f);
  for (int f = 0; f < shape.fingers; ++f) {
    const float offset = spread * (0.5f * (fingers - 1.0f) - static_cast<float>(f));
    const Vec3f way = (along + 2.6f * offset * front).normalized();
    add_finger(body, hand, name + names[f], knuckles + offset * s * front, way, lengths[f] * s, std::max(radius, 0.0125f) * s, habits);
  }
  return hand;
}

}  // namespace osteon::synth
