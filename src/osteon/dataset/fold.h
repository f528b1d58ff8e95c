// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "osteon/base/random.h"
#include "osteon/dataset/prepared.h"

namespace osteon::dataset {

// The same character with a coarser rig, as another artist might have made it: joints that move little of the body (tips, eyes, fingers,
// twists, clavicles) are folded into their parents one after the other, with their weights, until `joints` are left. What a joint moves is
// the sum of its weights over the vertices, blurred by exp(0.5 normal) so that not every character loses the same ones; with `symmetry`
// mirror partners go together. The root stays; poses do not. What follows from the joints is left as it was: derive_from_shape().
// Pre: joints >= 1.
PreparedCharacter folded(const PreparedCharacter& character, std::size_t joints, const std::optional<Plane>& symmetry, Random& random);

}  // namespace osteon::dataset
