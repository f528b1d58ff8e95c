// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "osteon/base/types.h"

namespace osteon::io {

// Cuts a polygon, given by its corners in order, into corners.size() - 2 triangles with the polygon's orientation: triples of places in
// `corners`. Concave polygons are cut by ears (G. H. Meisters. Polygons have ears. Amer. Math. Monthly 82, 1975) in the plane of their
// Newell normal, so that no triangle leaves the polygon; nothing can be promised for one that crosses itself or is far from plane. Appends
// to `triangles`. Fewer than 3 corners give none.
void triangulate(std::span<const Vec3f> corners, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace osteon::io
