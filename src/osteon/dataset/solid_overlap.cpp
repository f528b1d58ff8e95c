// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/solid_overlap.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>

#include "osteon/geometry/voxel_grid.h"
#include "osteon/geometry/working_mesh.h"

namespace osteon::dataset {

Solid solid_of(const TriangleMesh& mesh) {
  constexpr int cells = 88;
  const geometry::Normalization normalization = geometry::normalization_of(mesh);
  TriangleMesh normalised = mesh;
  for (Vec3f& p : normalised.positions) p = normalization.apply(p);
  const geometry::VoxelGrid grid = geometry::voxelize(normalised, cells);
  Solid out{std::vector<std::uint64_t>((cells * cells * cells + 63) / 64, 0)};
  std::size_t cell = 0;
  for (int x = 0; x < cells; ++x)
    for (int y = 0; y < cells; ++y)
      for (int z = 0; z < cells; ++z, ++cell) {
        const Vec3f centre = (Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) + Vec3f::Constant(0.5f)) / cells;
        if (grid.inside(centre - Vec3f(0.5f, 0.0f, 0.5f))) out.bits[cell / 64] |= std::uint64_t{1} << (cell % 64);
      }
  return out;
}

double overlap(const Solid& a, const Solid& b) {
  assert(a.bits.size() == b.bits.size());
  int both = 0, either = 0;
  for (std::size_t i = 0; i < a.bits.size(); ++i) {
    both += std::popcount(a.bits[i] & b.bits[i]);
    either += std::popcount(a.bits[i] | b.bits[i]);
  }
  return either > 0 ? static_cast<double>(both) / either : 1.0;
}

}  // namespace osteon::dataset
