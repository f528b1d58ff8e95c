// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/dataset/prepared.h"

namespace osteon::dataset {

// Indices of characters, ascending.
struct Holdout {
  std::vector<std::size_t> train, validation;
};

// Chooses about `share` of the characters for validation, at least one. What belongs together stays on one side: characters of one group,
// and copies of one another (solid_overlap.h; chains of copies too). The same for the same seed. Throws Error when there are not two
// characters that may be on different sides.
Holdout hold_out(std::span<const PreparedCharacter> characters, double share, std::uint64_t seed);

}  // namespace osteon::dataset
