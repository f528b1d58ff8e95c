// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string_view>

#include "osteon/base/random.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/synth/biped.h"
#include "osteon/synth/polygonize.h"

namespace osteon::test {

// A generated biped in the frame of the networks. Its joints are exact: "LeftHand", "LeftHandThumb", "LeftHandIndex1", ...
struct FigureWithHands {
  TriangleMesh mesh;
  Skeleton skeleton;

  Vec3f at(std::string_view joint) const {
    const auto& names = skeleton.names.raw();
    return skeleton.rest_positions.raw()[static_cast<std::size_t>(std::ranges::find(names, joint) - names.begin())];
  }
};

// `fingers`: beside the thumb; 0: a mitten.
inline FigureWithHands figure_with_hands(int fingers, std::uint64_t seed = 3, int cells = 260) {
  Random random(seed);
  synth::BipedShape shape(random);
  shape.fingers = fingers;
  shape.hands = 1.2f;
  shape.arm_pairs = 1;
  shape.outfit = {};
  shape.tail = 0.0f;
  synth::Habits habits(random);
  habits.phalanges = 3;
  habits.knees = true;
  habits.ends = false;
  const synth::Body body = make_biped(shape, habits);
  const Eigen::AlignedBox3f box = body.box();
  FigureWithHands out{synth::polygonize([&](const Vec3f& centre, float radius) { return body.near(centre, radius); }, box,
                                        box.sizes().maxCoeff() / static_cast<float>(cells)),
                      body.skeleton()};
  const geometry::Normalization frame = geometry::normalization_of(out.mesh);
  for (Vec3f& p : out.mesh.positions) p = frame.apply(p);
  for (Vec3f& p : out.skeleton.rest_positions) p = frame.apply(p);
  return out;
}

}  // namespace osteon::test
