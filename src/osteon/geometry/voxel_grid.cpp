// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/voxel_grid.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "osteon/base/parallel.h"

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
  std::vector<Corners> out;
  out.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces) {
    const auto in_cells = [&](VertexId v) -> Array3f { return ((mesh.positions[v] - grid.origin) / grid.cell).array(); };
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

// Lines through the cells' centres along one axis, and how often each goes into (+1) or out of (-1) the body at each cell. Corners are
// rounded to 1/1024 cell, so that edge tests are exact and a line through an edge or corner crosses exactly one of the faces around it.
class View {
 public:
  View(const std::vector<Corners>& faces, const VoxelGrid& grid, int axis)
      : size_(grid.size), axis_(axis), u_((axis + 1) % 3), v_((axis + 2) % 3), depth_(grid.voxels.size(), 0) {
    strides_ = Array3i(size_.y() * size_.z(), size_.z(), 1);
    for (const Corners& t : faces) add(t);
    sum_along_axis();
  }

  // 0, 1 or 2: how many of the views from the two ends of the axis see the cell inside.
  std::uint8_t votes(const Array3i& cell) const {
    const int here = depth_[offset(cell)];
    Array3i last = cell;
    last[axis_] = size_[axis_] - 1;
    const int beyond = depth_[offset(last)];  // not 0 where the mesh is open
    return static_cast<std::uint8_t>((here >= 1) + (here - beyond >= 1));
  }

 private:
  static constexpr std::int64_t kUnit = 1024;
  struct Point {
    std::int64_t u, v;
  };

  std::size_t offset(const Array3i& cell) const { return static_cast<std::size_t>((cell * strides_).sum()); }

  // Twice the signed area of abp.
  static std::int64_t area(const Point& a, const Point& b, const Point& p) { return (b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u); }
  // Lines exactly on an edge belong to the face for which the edge runs up, or flat to the left.
  static bool owns(const Point& a, const Point& b) { return b.v > a.v || (b.v == a.v && b.u < a.u); }

  static int first_line(std::int64_t low) { return static_cast<int>((low - kUnit / 2 + kUnit - 1) / kUnit); }
  static int last_line(std::int64_t high) { return static_cast<int>((high - kUnit / 2) / kUnit); }

  void add(const Corners& t) {
    std::array<Point, 3> p;
    std::array<float, 3> depth;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = {std::llround(t[k][u_] * kUnit), std::llround(t[k][v_] * kUnit)};
      depth[k] = t[k][axis_];
    }
    const std::int64_t whole = area(p[0], p[1], p[2]);
    if (whole == 0) return;
    const bool leaves = whole > 0;  // the normal looks along the axis
    if (!leaves) {
      std::swap(p[1], p[2]);
      std::swap(depth[1], depth[2]);
    }
    const auto [low_u, high_u] = std::minmax({p[0].u, p[1].u, p[2].u});
    const auto [low_v, high_v] = std::minmax({p[0].v, p[1].v, p[2].v});
    for (int iu = first_line(low_u); iu <= last_line(high_u); ++iu)
      for (int iv = first_line(low_v); iv <= last_line(high_v); ++iv) cross(p, depth, iu, iv, leaves ? -1 : 1);
  }

  void cross(const std::array<Point, 3>& p, const std::array<float, 3>& depth, int iu, int iv, int sign) {
    const Point line{iu * kUnit + kUnit / 2, iv * kUnit + kUnit / 2};
    std::array<std::int64_t, 3> w;  // opposite corner k
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
      w[k] = area(a, b, line);
      if (w[k] < 0 || (w[k] == 0 && !owns(a, b))) return;
    }
    const double whole = static_cast<double>(w[0] + w[1] + w[2]);
    double at = 0.0;
    for (std::size_t k = 0; k < 3; ++k) at += static_cast<double>(w[k]) / whole * static_cast<double>(depth[k]);
    Array3i cell;  // the first whose centre lies behind the face
    cell[axis_] = std::clamp(static_cast<int>(std::ceil(at - 0.5)), 0, size_[axis_] - 1);
    cell[u_] = iu;
    cell[v_] = iv;
    depth_[offset(cell)] = static_cast<std::int16_t>(depth_[offset(cell)] + sign);
  }

  void sum_along_axis() {
    const std::size_t stride = static_cast<std::size_t>(strides_[axis_]), run = stride * static_cast<std::size_t>(size_[axis_]);
    for (std::size_t start = 0; start < depth_.size(); start += run)
      for (std::size_t i = start + stride; i < start + run; ++i) depth_[i] = static_cast<std::int16_t>(depth_[i] + depth_[i - stride]);
  }

  Array3i size_, strides_;
  int axis_, u_, v_;
  std::vector<std::int16_t> depth_;  // entries minus exits up to each cell's centre
};

void vote_interior(const std::vector<Corners>& faces, VoxelGrid& grid) {
  constexpr int kMajority = 4;  // of six
  std::array<std::optional<View>, 3> views;
  parallel_for(3, 1, [&](std::size_t begin, std::size_t) { views[begin].emplace(faces, grid, static_cast<int>(begin)); });
  parallel_for(static_cast<std::size_t>(grid.size.x()), 8, [&](std::size_t begin, std::size_t end) {
    for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int k = 0; k < grid.size.z(); ++k) {
          Voxel& voxel = grid.voxels[grid.index({i, j, k})];
          if (voxel == Voxel::Surface) continue;
          int votes = 0;
          for (const auto& view : views) votes += view->votes({i, j, k});
          if (votes >= kMajority) voxel = Voxel::Interior;
        }
  });
}

// Voxels that the outside cannot reach through faces of voxels without touching the surface are inside, whatever the views say
// (pieces whose faces look inwards, cavities).
void fill_sealed(VoxelGrid& grid) {
  const std::size_t sy = static_cast<std::size_t>(grid.size.z()), sx = sy * static_cast<std::size_t>(grid.size.y());
  const std::size_t nx = static_cast<std::size_t>(grid.size.x()), ny = static_cast<std::size_t>(grid.size.y()), nz = sy;
  std::vector<std::uint8_t> open(grid.voxels.size(), 0);
  std::vector<std::size_t> todo{0};  // a corner of the margin
  open[0] = 1;
  const auto visit = [&](std::size_t at) {
    if (open[at] || grid.voxels[at] == Voxel::Surface) return;
    open[at] = 1;
    todo.push_back(at);
  };
  while (!todo.empty()) {
    const std::size_t at = todo.back();
    todo.pop_back();
    const std::size_t i = at / sx, j = at % sx / sy, k = at % sy;
    if (i > 0) visit(at - sx);
    if (i + 1 < nx) visit(at + sx);
    if (j > 0) visit(at - sy);
    if (j + 1 < ny) visit(at + sy);
    if (k > 0) visit(at - 1);
    if (k + 1 < nz) visit(at + 1);
  }
  for (std::size_t at = 0; at < open.size(); ++at)
    if (!open[at] && grid.voxels[at] == Voxel::Outside) grid.voxels[at] = Voxel::Interior;
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
