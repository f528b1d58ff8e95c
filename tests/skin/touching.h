// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "osteon/mesh/shapes.h"
#include "osteon/rig/rig.h"

namespace osteon::test {

struct Bound {
  TriangleMesh mesh;
  Skeleton skeleton;
};

// `count` upright capsules of radius 0.1 and length 1 side by side, each surface touching the next, with a bone each; all bones hang on a
// root below them, outside of them.
inline Bound touching_capsules(int count) {
  Bound out;
  const float left = -0.1f * static_cast<float>(count - 1);
  const JointId root = out.skeleton.add("root", std::nullopt, {0, -0.5f, 0});
  for (int i = 0; i < count; ++i) {
    const float x = left + 0.2f * static_cast<float>(i);
    const TriangleMesh one = shapes::transformed(shapes::capsule(0.1f, 1.0f, 24, 8), Transform(Eigen::Translation3f(x, 0, 0)));
    out.mesh = i == 0 ? one : shapes::merged(out.mesh, one);
    const JointId start = out.skeleton.add("bone" + std::to_string(i), root, {x, 0, 0});
    out.skeleton.add("tip" + std::to_string(i) + "_end", start, {x, 1, 0});
  }
  return out;
}

// The largest weight of joints other than `own` and the root, over the vertices that `is_mine` picks.
template <class IsMine>
float largest_foreign_weight(const SkinWeights& weights, const std::vector<JointId>& own, const IsMine& is_mine) {
  float most = 0.0f;
  for (VertexId v : ids<VertexId>(weights.size())) {
    if (!is_mine(v)) continue;
    float foreign = 0.0f;
    for (const Influence& i : weights[v])
      if (i.joint != JointId{0} && std::ranges::find(own, i.joint) == own.end()) foreign += i.weight;
    most = std::max(most, foreign);
  }
  return most;
}

}  // namespace osteon::test
