// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "osteon/synth/body.h"

namespace osteon::synth {

// A point of a limb's middle line. Where it has a name a joint stands; the limb's next stretch is bound to the last joint before it.
struct ChainPoint {
  std::string name;  // of the joint at this point; empty: none
  Vec3f position;
  float radius;
};
enum class Rows { Single, Paired };  // joints of the middle plane, or a left chain and its twin on the right

// Adds the chain below `parent` and clothes it with a round cone from each point to the next; returns its joints (the left ones of a pair).
// A name at the last point makes an end joint, which binds nothing; a chain without a name at its first point begins as part of `parent`.
// `blend` is in units of the smaller radius. `flat` gives the cones' section; its axis is ignored.
std::vector<JointId> add_chain(Body& body, std::optional<JointId> parent, Rows rows, const std::vector<ChainPoint>& points,
                               float blend = 0.6f, const RoundCone& flat = {});

// The points of a limb whose shape is given by `shape` (names are not read), with `joints` joints at equal steps along its length, the
// first at its beginning: "Tail", "Tail1", "Tail2", ... for the name "Tail". Without joints the limb belongs to its parent.
std::vector<ChainPoint> jointed(const std::vector<ChainPoint>& shape, const std::string& name, int joints);

}  // namespace osteon::synth
