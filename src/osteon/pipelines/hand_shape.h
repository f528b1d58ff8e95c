// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::pipelines {

struct FingerShape {
  Vec3f tip;
  std::vector<Vec3f> joints;  // (3) from the hand outwards
  float wide;                 // half of its width
};

struct HandShape {
  std::optional<Vec3f> wrist;
  std::vector<FingerShape> fingers;  // (4 or 5) the thumb first, then as they stand beside it
};

// The hand at the end of a limb, if it has fingers. What artists do with hands is much alike, and finer than what the networks tell apart:
// so it is found by geometry. The surface within 0.32 of `end` is followed away from `from`, a point further up the limb. Where it parts
// into four or five long, thin, round branches (geometry/branches.h) off the ground, with vertices enough to bend, that is a hand; the
// thumb is the branch that leaves it first. With 0 at a fingertip and 1 at the web where the finger meets others, by the distance along
// the surface, joints of fingers lie at 0.40, 0.75 and 1.2 in the middle of the surface's sections (beyond 1 on the straight line), those
// of thumbs at 0.68, 1.42 and 2.2; each finger has its own, a few hundredths from these. The wrist is a tenth of the median finger before
// the narrowest section between 0.6 and 2.2 of that length from the thumb's web; none where the surface ends before, or that is not near.
// Medians over the six groups of training characters with such hands; half of their joints are within 0.03, the last within 0.05. Ours,
// from no paper. `mesh`: not reduced; frame: y up, feet on y = 0, longest side 1.
std::optional<HandShape> find_hand(const TriangleMesh& mesh, const Vec3f& end, const Vec3f& from);

}  // namespace osteon::pipelines
