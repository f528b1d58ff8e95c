// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "osteon/base/types.h"

namespace osteon::metrics {

// The one-to-one assignment of rows to columns with the least total cost; min(rows, columns) pairs. out[row] is the row's column, empty
// where more rows than columns leave it alone. The Hungarian method with potentials and shortest augmenting paths (Kuhn 1955; the O(n^3)
// form of Jonker and Volgenant, "A shortest augmenting path algorithm for dense and sparse linear assignment problems", 1987). Pre: costs
// are finite.
std::vector<std::optional<std::size_t>> assign(const Matrix& cost);

}  // namespace osteon::metrics
