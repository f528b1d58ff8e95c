// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/voxel_grid.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "osteon/base/parallel.h"
#include "osteon/geometry/axis_crossings.h"

namespace osteon::geometry {
namespace {

using Eigen::Array3f;
using Eigen::Array3i;
using Corners = std::array<Array3f, 3>;  // of a face, in cells

VoxelGrid empty_grid(const TriangleMesh& mesh, int resolution) {
  const Eigen::AlignedBox3f box = bounds(mesh);
  const float longest = box.sizes().maxCoeff();
  VoxelGrid grid;
  // The box is a trifle smaller than the cells it fills, so that no face touches the margin: the outside stays connected.
  grid.cell = longest > 0.0f ? longest / (static_cast<float>(resolution) - 0.01f) : 1.0f;
  const Array3i filled = (box.sizes().array() / grid.cell + 0.002f).ceil().cast<int>();
  grid.size = filled + 2;
  grid.origin = box.center() - 0.5f * grid.cell * grid.size.cast<float>().matrix();
  grid.voxels.assign(static_cast<std::size_t>(grid.size.prod()), Voxel::Outside);
  return grid;
}

std::vector<Corners> corners_in_cells(const TriangleMesh& mesh, const VoxelGrid& grid) {
  const Array3f end = grid.size.cast<float>() - 1.0f;
  std::vector<Corners> out;
  out.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces) {
    // Far from the origin coordinates may be coarser than cells: nothing is put into the margin all the same.
    const auto in_cells = [&](VertexId v) -> Array3f { return ((mesh.positions[v] - grid.origin) / grid.cell).array().max(1.0f).min(end); };
    out.push_back({in_cells(a), in_cells(b), in_cells(c)});
  }
  return out;
}

// Which unit cubes a triangle touches: Schwarz and Seidel 2010, section 3.1, equations 1 to 4. Sums are compared with a margin of
// kRounding, so that a cube whose face lies in the triangle's plane counts whatever the rounding.
class TouchTest {
 public:
  explicit TouchTest(const Corners& t) {
    normal_ = (t[1] - t[0]).matrix().cross((t[2] - t[0]).matrix()).array();
    const Array3f critical = (normal_ > 0.0f).cast<float>();
    near_ = (normal_ * (critical - t[0])).sum();
    far_ = (normal_ * (1.0f - critical - t[0])).sum();
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t k = 0; k < 3; ++k) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const Array3f edge = t[(k + 1) % 3] - t[k];
        const float sign = normal_[axis] >= 0.0f ? 1.0f : -1.0f;
        Side& side = sides_[static_cast<std::size_t>(axis) * 3 + k];
        side.u = -edge[v] * sign;
        side.v = edge[u] * sign;
        side.offset = -side.u * t[k][u] - side.v * t[k][v] + std::max(0.0f, side.u) + std::max(0.0f, side.v);
      }
  }

  bool touches(const Array3i& cube) const {
    const Array3f low = cube.cast<float>();
    const float at = (normal_ * low).sum();
    const float margin = kRounding * normal_.abs().sum();
    if (at + near_ < -margin || at + far_ > margin) return false;
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      const int axis = static_cast<int>(s / 3);
      const Side& side = sides_[s];
      const float slack = kRounding * (std::abs(side.u) + std::abs(side.v));
      if (side.u * low[(axis + 1) % 3] + side.v * low[(axis + 2) % 3] + side.offset < -slack) return false;
    }
    return true;
  }

 private:
  static constexpr float kRounding = 1e-4f;  // of a cell
  struct Side {
    float u, v, offset;
  };
  Array3f normal_;
  float near_, far_;
  std::array<Side, 9> sides_;  // of the projections along x, y, z
};

void mark_surface(const std::vector<Corners>& faces, VoxelGrid& grid) {
  constexpr std::size_t kSlab = 8;  // planes of equal x that one thread fills
  parallel_for(static_cast<std::size_t>(grid.size.x()), kSlab, [&](std::size_t begin, std::size_t end) {
    for (const Corners& t : faces) {
      Array3i low = t[0].min(t[1]).min(t[2]).floor().cast<int>().max(0);
      Array3i high = t[0].max(t[1]).max(t[2]).floor().cast<int>().min(grid.size - 1);
      low.x() = std::max(low.x(), static_cast<int>(begin));
      high.x() = std::min(high.x(), static_cast<int>(end) - 1);
      if ((low > high).any()) continue;
      const TouchTest test(t);
      for (int i = low.x(); i <= high.x(); ++i)
        for (int j = low.y(); j <= high.y(); ++j)
          for (int k = low.z(); k <= high.z(); ++k)
            if (test.touches({i, j, k})) grid.voxels[grid.index({i, j, k})] = Voxel::Surface;
    }
  });
}

// How often the lines through the cells' centres along one axis go into (+1) or out of (-1) the body at each cell.
class View {
 public:
  View(const std::vector<Corners>& faces, const VoxelGrid& grid, int axis) : size_(grid.size), axis_(axis), depth_(grid.voxels.size(), 0) {
    strides_ = Array3i(size_.y() * size_.z(), size_.z(), 1);
    const AxisCrossings lines(axis);
    for (const Corners& t : faces)
      lines.visit(t, [&](int iu, int iv, double at, int sign) {
        Array3i cell;  // the first whose centre lies behind the face
        cell[axis] = std::clamp(static_cast<int>(std::ceil(at - 0.5)), 0, size_[axis] - 1);
        cell[(axis + 1) % 3] = iu;
        cell[(axis + 2) % 3] = iv;
        std::int16_t& depth = depth_[static_cast<std::size_t>((cell * strides_).sum())];
        depth = static_cast<std::int16_t>(depth + sign);
      });
    sum_along_axis();
  }

  // For each cell 0, 1 or 2: how many of the views from the two ends of the axis see its centre inside.
  std::vector<std::uint8_t> votes() const {
    std::vector<std::uint8_t> out(depth_.size());
    const std::size_t stride = static_cast<std::size_t>(strides_[axis_]), run = stride * static_cast<std::size_t>(size_[axis_]);
    for (std::size_t start = 0; start < depth_.size(); start += run) {
      const std::int16_t* beyond = &depth_[start + run - stride];  // not 0 where the mesh is open
      for (std::size_t row = start; row < start + run; row += stride)
        for (std::size_t i = 0; i < stride; ++i)
          out[row + i] = static_cast<std::uint8_t>((depth_[row + i] >= 1) + (depth_[row + i] - beyond[i] >= 1));
    }
    return out;
  }

 private:
  void sum_along_axis() {
    const std::size_t stride = static_cast<std::size_t>(strides_[axis_]), run = stride * static_cast<std::size_t>(size_[axis_]);
    for (std::size_t start = 0; start < depth_.size(); start += run)
      for (std::size_t i = start + stride; i < start + run; ++i) depth_[i] = static_cast<std::int16_t>(depth_[i] + depth_[i - stride]);
  }

  Array3i size_, strides_;
  int axis_;
  std::vector<std::int16_t> depth_;  // entries minus exits up to each cell's centre
};

void vote_interior(const std::vector<Corners>& faces, VoxelGrid& grid) {
  constexpr int kMajority = 4;  // of six
  std::array<std::vector<std::uint8_t>, 3> votes;
  parallel_for(3, 1, [&](std::size_t begin, std::size_t) { votes[begin] = View(faces, grid, static_cast<int>(begin)).votes(); });
  for (std::size_t i = 0; i < grid.voxels.size(); ++i)
    if (votes[0][i] + votes[1][i] + votes[2][i] >= kMajority && grid.voxels[i] != Voxel::Surface) grid.voxels[i] = Voxel::Interior;
}

// Voxels in a row along z, none of them touched by the surface.
struct Run {
  int begin, end;
};

// Which runs hang together through faces of voxels.
class RunForest {
 public:
  explicit RunForest(const VoxelGrid& grid) : lines_(static_cast<std::size_t>(grid.size.x() * grid.size.y()) + 1) {
    const int ny = grid.size.y(), nz = grid.size.z();
    for (int line = 0; line < grid.size.x() * ny; ++line) {
      add_runs(&grid.voxels[static_cast<std::size_t>(line) * static_cast<std::size_t>(nz)], nz);
      lines_[static_cast<std::size_t>(line) + 1] = runs_.size();
      if (line % ny > 0) join_lines(static_cast<std::size_t>(line - 1), static_cast<std::size_t>(line));
      if (line >= ny) join_lines(static_cast<std::size_t>(line - ny), static_cast<std::size_t>(line));
    }
  }

  std::size_t lines() const { return lines_.size() - 1; }
  // Calls visit(run) for the runs of a line that do not hang together with the first run of all, a corner of the margin.
  template <class Visit>
  void sealed_runs(std::size_t line, Visit visit) {
    for (std::size_t r = lines_[line]; r < lines_[line + 1]; ++r)
      if (root(r) != 0) visit(runs_[r]);
  }

 private:
  void add_runs(const Voxel* line, int length) {
    for (int k = 0; k < length; ++k) {
      if (line[k] == Voxel::Surface) continue;
      const int begin = k;
      while (k < length && line[k] != Voxel::Surface) ++k;
      parents_.push_back(runs_.size());
      runs_.push_back({begin, k});
    }
  }

  void join_lines(std::size_t before, std::size_t line) {
    for (std::size_t a = lines_[before], b = lines_[line]; a < lines_[before + 1] && b < lines_[line + 1];) {
      if (runs_[a].begin < runs_[b].end && runs_[b].begin < runs_[a].end) join(root(a), root(b));
      ++(runs_[a].end < runs_[b].end ? a : b);
    }
  }

  void join(std::size_t a, std::size_t b) { parents_[std::max(a, b)] = std::min(a, b); }

  std::size_t root(std::size_t run) {
    while (parents_[run] != run) run = parents_[run] = parents_[parents_[run]];  // path halving
    return run;
  }

  std::vector<std::size_t> lines_;  // runs of line l: lines_[l] .. lines_[l + 1]
  std::vector<Run> runs_;
  std::vector<std::size_t> parents_;
};

// Voxels that the outside cannot reach through faces of voxels without touching the surface are inside, whatever the views say
// (pieces whose faces look inwards, cavities).
void fill_sealed(VoxelGrid& grid) {
  RunForest runs(grid);
  for (std::size_t line = 0; line < runs.lines(); ++line)
    runs.sealed_runs(line, [&](const Run& run) {
      Voxel* first = &grid.voxels[line * static_cast<std::size_t>(grid.size.z())];
      std::fill(first + run.begin, first + run.end, Voxel::Interior);
    });
}

}  // namespace

Voxel VoxelGrid::at(const Vec3f& p) const {
  const Array3f cells = ((p - origin) / cell).array();
  if (!(cells >= 0.0f).all() || !(cells < size.cast<float>()).all()) return Voxel::Outside;
  return voxels[index(cells.cast<int>())];
}

VoxelGrid voxelize(const TriangleMesh& mesh, int resolution) {
  assert(resolution > 0);
  VoxelGrid grid = empty_grid(mesh, resolution);
  const std::vector<Corners> faces = corners_in_cells(mesh, grid);
  mark_surface(faces, grid);
  vote_interior(faces, grid);
  fill_sealed(grid);
  return grid;
}

int sample_count(const Segment& segment, float step) {
  return std::max(1, static_cast<int>(std::lround((segment.b - segment.a).norm() / step)));
}

int samples_outside(const VoxelGrid& grid, const Segment& segment, float step) {
  const int n = sample_count(segment, step);
  int outside = 0;
  for (int i = 1; i <= n; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(n);
    if (!grid.inside((1.0f - t) * segment.a + t * segment.b)) ++outside;
  }
  return outside;
}

float inside_fraction(const VoxelGrid& grid, const Segment& segment, float step) {
  return 1.0f - static_cast<float>(samples_outside(grid, segment, step)) / static_cast<float>(sample_count(segment, step));
}

}  // namespace osteon::geometry
