// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::dataset {

// The solid of a character as bits in a cube of 88^3 cells that holds the frame of the networks (longest side 1, feet on y = 0, centred on
// x and z), so that two of them can be compared cell by cell.
struct Solid {
  std::vector<std::uint64_t> bits;
};

// Throws Error for a mesh without extent. Pre: validate(mesh) holds.
Solid solid_of(const TriangleMesh& mesh);

// Intersection over union, 0..1. Above 0.95 two characters are copies of one another (RigNet, section 6: its test set has none of these).
double overlap(const Solid& a, const Solid& b);

}  // namespace osteon::dataset
