// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/base/random.h"
#include "osteon/synth/body.h"

// One file a kind of animal. Each draws its proportions from `random`, then builds the body from them: feet on about y = 0, facing +z.
namespace osteon::synth {

Body make_biped(Random& random);
Body make_quadruped(Random& random);
Body make_bird(Random& random);
Body make_fish(Random& random);
Body make_many_legged(Random& random);

// Joints and round cones along a chain: from each point to the next, the last joint standing on the point before the last.
struct ChainPoint {
  std::string name;  // of the joint at this point; not used for the last point, which only ends the last cone
  Vec3f position;
  float radius;
};
enum class Rows { Single, Paired };  // joints of the middle plane, or a left chain and its twin on the right
// Adds the chain below `parent` and clothes it; returns its joints (the left ones of a pair). `blend` is in units of the smaller radius.
// `flat` gives the cones' section; its axis is ignored.
std::vector<JointId> add_chain(Body& body, std::optional<JointId> parent, Rows rows, const std::vector<ChainPoint>& points,
                               float blend = 0.6f, const RoundCone& flat = {});

}  // namespace osteon::synth
