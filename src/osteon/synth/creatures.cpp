// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/creatures.h"

#include <algorithm>
#include <cassert>

namespace osteon::synth {

std::vector<JointId> add_chain(Body& body, std::optional<JointId> parent, Rows rows, const std::vector<ChainPoint>& points, float blend,
                               const RoundCone& flat) {
  assert(points.size() >= 2);
  std::vector<JointId> joints;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const ChainPoint &from = points[i], &to = points[i + 1];
    const JointId joint =
        rows == Rows::Paired ? body.pair(from.name, *parent, from.position) : body.joint(from.name, parent, from.position);
    RoundCone cone = flat;
    cone.axis = {from.position, to.position};
    cone.radius_a = from.radius;
    cone.radius_b = to.radius;
    body.clothe(joint, cone, blend * std::min(from.radius, to.radius));
    joints.push_back(joint);
    parent = joint;
  }
  return joints;
}

}  // namespace osteon::synth
