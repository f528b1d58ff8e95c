// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/chain.h"

#include <algorithm>
#include <cassert>

namespace osteon::synth {
namespace {

constexpr float kShare = 0.4f;  // largest blend within a chain by the length of the cone

}  // namespace

std::vector<JointId> add_chain(Body& body, std::optional<JointId> parent, Rows rows, const std::vector<ChainPoint>& points, float blend,
                               const RoundCone& flat) {
  assert(points.size() >= 2 && (parent || !points.front().name.empty()));
  std::vector<JointId> joints;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ChainPoint& from = points[i];
    if (!from.name.empty()) {
      parent = rows == Rows::Paired ? body.pair(from.name, *parent, from.position) : body.joint(from.name, parent, from.position);
      joints.push_back(*parent);
    }
    if (i + 1 == points.size()) break;
    const ChainPoint& to = points[i + 1];
    RoundCone cone = flat;
    cone.axis = {from.position, to.position};
    cone.radius_a = from.radius;
    cone.radius_b = to.radius;
    // The first melts into the body that carries the chain. Each further one adds a little to those before it where they overlap, so the
    // many short ones of a finely drawn limb must melt little, or the limb would swell.
    const float wide = blend * std::min(from.radius, to.radius);
    body.clothe(*parent, cone, i == 0 ? wide : std::clamp(kShare * (to.position - from.position).norm(), 0.1f * wide, wide));
  }
  return joints;
}

std::vector<ChainPoint> jointed(const std::vector<ChainPoint>& shape, const std::string& name, int joints) {
  assert(shape.size() >= 2);
  float length = 0.0f;
  for (std::size_t i = 1; i < shape.size(); ++i) length += (shape[i].position - shape[i - 1].position).norm();
  std::vector<ChainPoint> points;
  float passed = 0.0f;
  int next = 0;
  for (std::size_t i = 0; i + 1 < shape.size(); ++i) {
    const ChainPoint &from = shape[i], &to = shape[i + 1];
    const float step = (to.position - from.position).norm();
    points.push_back({"", from.position, from.radius});
    for (; next < joints; ++next) {
      const float t = (static_cast<float>(next) / static_cast<float>(joints) * length - passed) / step;
      if (t >= 0.999f) break;
      const std::string label = next == 0 ? name : name + std::to_string(next);
      if (t < 0.001f)
        points.back().name = label;
      else
        points.push_back({label, from.position + t * (to.position - from.position), from.radius + t * (to.radius - from.radius)});
    }
    passed += step;
  }
  points.push_back({"", shape.back().position, shape.back().radius});
  return points;
}

}  // namespace osteon::synth
