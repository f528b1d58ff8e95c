// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/solid_lattice.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "osteon/base/parallel.h"
#include "osteon/geometry/axis_crossings.h"
#include "osteon/geometry/buckets.h"
#include "osteon/geometry/orientation.h"

namespace osteon::geometry {
namespace {

using Eigen::Array3f;
using Eigen::Array3i;

constexpr std::size_t kLinesPerTask = 64, kNodesPerTask = 4096;
constexpr int kMajority = 4;  // of six views
constexpr int kCoarse = 64;   // resolution of the first look

// What is known of a cell: the views that see its centre inside, and what lies between it and the next centre along each axis.
constexpr std::uint8_t kVotes = 7, kOverlap = 64;
constexpr std::uint8_t wall(int axis) { return static_cast<std::uint8_t>(8 << axis); }

struct Crossing {
  float at;  // along the axis, in cells
  std::int8_t sign;
  std::uint32_t part;
};

// The windings along one line, summed from its start.
class Line {
 public:
  Line(std::span<Crossing> crossings, int length) : crossings_(crossings), length_(length) {
    // Ties: out before in, so that parts that touch in a plane stay apart.
    std::ranges::sort(crossings_, {}, [](const Crossing& c) { return std::tuple(c.at, c.sign, c.part); });
    for (const Crossing& c : crossings_) beyond_ += c.sign;
  }

  // Calls put(cell, flags) for the cells that the line sees something of; `axis` names the walls.
  template <class Put>
  void visit(int axis, const Put& put) {
    int depth = 0;
    for (std::size_t k = 0; k < crossings_.size();) {
      const int gap = cell_behind(crossings_[k]);  // the first centre behind these crossings
      int entries = 0, exits = 0;
      const int before = std::max(depth, depth - beyond_);
      for (; k < crossings_.size() && cell_behind(crossings_[k]) == gap; ++k) {
        const Crossing& c = crossings_[k];
        ++(c.sign > 0 ? entries : exits);
        depth += c.sign;
        count(c);
      }
      if (gap > 0 && entries > 0 && exits > 0 && before - exits <= 0) put(gap - 1, wall(axis));
      const int end = k < crossings_.size() ? cell_behind(crossings_[k]) : length_;
      const int votes = (depth >= 1) + (depth - beyond_ >= 1);
      if (votes == 0) continue;
      const auto flags = static_cast<std::uint8_t>(votes | (overlapping_ > 0 ? kOverlap : 0));
      for (int cell = gap; cell < end; ++cell) put(cell, flags);
    }
  }

 private:
  int cell_behind(const Crossing& c) const { return std::clamp(static_cast<int>(std::ceil(c.at - 0.5f)), 0, length_); }

  // Keeps count of the components that the line is in more than once.
  void count(const Crossing& c) {
    auto found = std::ranges::find(windings_, c.part, &std::pair<std::uint32_t, int>::first);
    if (found == windings_.end()) found = windings_.insert(found, {c.part, 0});
    overlapping_ -= found->second >= 2;
    found->second += c.sign;
    overlapping_ += found->second >= 2;
  }

  std::span<Crossing> crossings_;
  int length_, beyond_ = 0, overlapping_ = 0;
  std::vector<std::pair<std::uint32_t, int>> windings_;
};

class LatticeBuilder {
 public:
  LatticeBuilder(const TriangleMesh& mesh, const Components& parts, int resolution) : mesh_(mesh), parts_(parts) {
    const Eigen::AlignedBox3f box = bounds(mesh);
    const float longest = box.sizes().maxCoeff();
    out_.cell = longest > 0.0f ? longest / (static_cast<float>(resolution) - 0.01f) : 1.0f;
    out_.size = (box.sizes().array() / out_.cell + 0.002f).ceil().cast<int>() + 2;
    out_.origin = box.center() - 0.5f * out_.cell * out_.size.cast<float>().matrix();
    flags_.assign(static_cast<std::size_t>(out_.size.prod()), 0);
  }

  std::size_t count_nodes() {
    look_along_axes();
    return static_cast<std::size_t>(std::ranges::count_if(flags_, [&](std::uint8_t flags) { return is_inside(flags); }));
  }

  SolidLattice build() {
    look_along_axes();
    number_nodes();
    find_steps();
    return std::move(out_);
  }

 private:
  bool is_inside(std::uint8_t flags) const { return (flags & kVotes) >= kMajority && !(flags & kOverlap); }

  // Far from the origin coordinates may be coarser than cells: nothing is put into the margin all the same.
  std::array<Array3f, 3> in_cells(FaceId f) const {
    const Array3f end = out_.size.cast<float>() - 1.0f;
    std::array<Array3f, 3> out;
    for (std::size_t k = 0; k < 3; ++k)
      out[k] = ((mesh_.positions[mesh_.faces[f][k]] - out_.origin) / out_.cell).array().max(1.0f).min(end);
    return out;
  }

  Buckets<Crossing> crossings_along(int axis) const {
    const int across = out_.size[(axis + 2) % 3];
    const AxisCrossings lines(axis);
    return bucketed<Crossing>(static_cast<std::size_t>(out_.size[(axis + 1) % 3] * across), [&](const auto& put) {
      for (FaceId f : mesh_.faces.ids())
        lines.visit(in_cells(f), [&](int iu, int iv, double at, int sign) {
          put(static_cast<std::size_t>(iu * across + iv),
              Crossing{static_cast<float>(at), static_cast<std::int8_t>(sign), parts_.of[mesh_.faces[f][0]]});
        });
    });
  }

  void look_along_axes() {
    std::array<Buckets<Crossing>, 3> crossings;
    parallel_for(3, 1, [&](std::size_t begin, std::size_t) { crossings[begin] = crossings_along(static_cast<int>(begin)); });
    const Array3i strides(out_.size.y() * out_.size.z(), out_.size.z(), 1);
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      auto& lines = crossings[static_cast<std::size_t>(axis)];
      parallel_for(lines.size(), kLinesPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t l = begin; l < end; ++l) {
          const int iu = static_cast<int>(l) / out_.size[v], iv = static_cast<int>(l) % out_.size[v];
          std::uint8_t* first = flags_.data() + iu * strides[u] + iv * strides[v];
          Line(lines.of(l), out_.size[axis]).visit(axis, [&](int cell, std::uint8_t flags) {
            std::uint8_t& all = first[cell * strides[axis]];
            all = static_cast<std::uint8_t>(((all & kVotes) + (flags & kVotes)) | (all & ~kVotes) | (flags & ~kVotes));
          });
        }
      });
    }
  }

  void number_nodes() {
    out_.node_of.assign(flags_.size(), SolidLattice::kNone);
    std::uint32_t cell = 0;
    for (int i = 0; i < out_.size.x(); ++i)
      for (int j = 0; j < out_.size.y(); ++j)
        for (int k = 0; k < out_.size.z(); ++k, ++cell)
          if (is_inside(flags_[cell])) {
            out_.node_of[cell] = static_cast<std::uint32_t>(out_.cell_of.size());
            out_.cell_of.push_back(cell);
            out_.positions.push_back(out_.origin + out_.cell * (Array3i(i, j, k).cast<float>() + 0.5f).matrix());
          }
  }

  bool is_free(std::uint32_t cell, int axis, int sign) const {
    const Array3i strides(out_.size.y() * out_.size.z(), out_.size.z(), 1);
    const auto next = static_cast<std::uint32_t>(static_cast<int>(cell) + sign * strides[axis]);
    return is_inside(flags_[next]) && !(flags_[sign > 0 ? cell : next] & wall(axis));
  }

  // Whether some way of steps along the axes leads from the cell to the one that is `step` away; all cells with nodes are off the border.
  bool is_reached(std::uint32_t cell, Array3i step) const {
    const Array3i strides(out_.size.y() * out_.size.z(), out_.size.z(), 1);
    if ((step == 0).all()) return true;
    for (int axis = 0; axis < 3; ++axis) {
      if (step[axis] == 0 || !is_free(cell, axis, step[axis])) continue;
      Array3i rest = step;
      rest[axis] = 0;
      if (is_reached(static_cast<std::uint32_t>(static_cast<int>(cell) + step[axis] * strides[axis]), rest)) return true;
    }
    return false;
  }

  void find_steps() {
    out_.steps.assign(out_.nodes(), 0);
    parallel_for(out_.nodes(), kNodesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n)
        for (std::size_t k = 0; k < lattice_steps().size(); ++k)
          if (is_reached(out_.cell_of[n], lattice_steps()[k])) out_.steps[n] |= 1u << k;
    });
  }

  const TriangleMesh& mesh_;
  const Components& parts_;
  SolidLattice out_;
  std::vector<std::uint8_t> flags_;
};

}  // namespace

const std::array<Eigen::Array3i, 26>& lattice_steps() {
  static const auto steps = [] {
    std::array<Eigen::Array3i, 26> out;
    std::size_t k = 0;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int l = -1; l <= 1; ++l)
          if (i != 0 || j != 0 || l != 0) out[k++] = {i, j, l};
    return out;
  }();
  return steps;
}

SolidLattice solid_lattice(const TriangleMesh& mesh, int resolution, std::size_t most_nodes) {
  assert(resolution > 0);
  const Components parts = connected_components(mesh);
  const TriangleMesh outwards = faced_outwards(mesh, parts);
  if (resolution > kCoarse) {  // the cells inside grow with the cube of the resolution: a look at a few tells how many there will be
    const auto coarse = static_cast<double>(LatticeBuilder(outwards, parts, kCoarse).count_nodes());
    const double most = static_cast<double>(kCoarse) * std::cbrt(static_cast<double>(most_nodes) / std::max(1.0, coarse));
    resolution = std::max(kCoarse, static_cast<int>(std::min(static_cast<double>(resolution), most)));
  }
  return LatticeBuilder(outwards, parts, resolution).build();
}

}  // namespace osteon::geometry
