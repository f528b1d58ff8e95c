// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/branches.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "osteon/geometry/union_find.h"

namespace osteon::geometry {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

class JoinTree {
 public:
  JoinTree(const Neighbourhoods& ring, std::span<const float> distance, float least)
      : ring_(ring), distance_(distance), least_(least), pieces_(ring.size()), of_piece_(ring.size(), kNone), of_(ring.size(), kNone) {}

  std::vector<Branch> run() {
    for (std::uint32_t v : farthest_first()) {
      const std::uint32_t piece = piece_at(v);
      of_piece_[pieces_.find(v)] = piece;
      of_[v] = piece;
      order_.push_back(v);
    }
    for (std::uint32_t v : order_) found_[standing_for(of_[v])].vertices.push_back(static_cast<VertexId>(v));
    return without_absorbed();
  }

 private:
  std::vector<std::uint32_t> farthest_first() const {
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < distance_.size(); ++v)
      if (std::isfinite(distance_[v])) order.push_back(v);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t v) { return -distance_[v]; });
    return order;
  }

  // The branch that the vertex belongs to: one that begins here, or what those around it become.
  std::uint32_t piece_at(std::uint32_t v) {
    std::uint32_t here = kNone;
    for (std::uint32_t near : ring_.of(v)) {
      if (of_[near] == kNone) continue;
      const std::uint32_t other = of_piece_[pieces_.find(near)];
      pieces_.join(v, near);
      if (here == kNone)
        here = other;
      else if (other != here)
        here = met(here, other, distance_[v]);
      of_piece_[pieces_.find(v)] = here;
    }
    if (here != kNone) return here;
    return added(static_cast<VertexId>(v), distance_[v]);
  }

  std::uint32_t added(VertexId tip, float top) {
    found_.push_back({tip, top, 0.0f, std::nullopt, {}});
    absorbed_by_.push_back(kNone);
    has_children_.push_back(false);
    return static_cast<std::uint32_t>(found_.size() - 1);
  }

  std::uint32_t met(std::uint32_t a, std::uint32_t b, float level) {
    const bool b_is_longer = found_[b].top > found_[a].top || (found_[b].top == found_[a].top && b < a);
    if (b_is_longer) std::swap(a, b);
    if (!has_children_[b] && found_[b].top - level < least_) {
      absorbed_by_[b] = a;
      return a;
    }
    const std::uint32_t joined = added(found_[a].tip, found_[a].top);
    has_children_[joined] = true;
    for (std::uint32_t child : {a, b}) {
      found_[child].base = level;
      found_[child].parent = joined;
    }
    return joined;
  }

  std::uint32_t standing_for(std::uint32_t branch) {
    while (absorbed_by_[branch] != kNone) {
      const std::uint32_t next = absorbed_by_[branch];
      if (absorbed_by_[next] != kNone) absorbed_by_[branch] = absorbed_by_[next];  // path halving
      branch = next;
    }
    return branch;
  }

  std::vector<Branch> without_absorbed() {
    std::vector<std::uint32_t> number(found_.size(), kNone);
    std::vector<Branch> out;
    for (std::uint32_t b = 0; b < found_.size(); ++b) {
      if (absorbed_by_[b] != kNone) continue;
      number[b] = static_cast<std::uint32_t>(out.size());
      out.push_back(std::move(found_[b]));
    }
    for (Branch& b : out)
      if (b.parent)
        b.parent = number[*b.parent];
      else
        b.base = b.vertices.empty() ? b.top : distance_[static_cast<std::size_t>(b.vertices.back())];
    return out;
  }

  const Neighbourhoods& ring_;
  std::span<const float> distance_;
  float least_;
  UnionFind pieces_;                     // vertices that hang together so far
  std::vector<std::uint32_t> of_piece_;  // of each such piece, by its name: its branch
  std::vector<std::uint32_t> of_;        // of each vertex: the branch when it came
  std::vector<std::uint32_t> order_;
  std::vector<Branch> found_;
  std::vector<std::uint32_t> absorbed_by_;
  std::vector<bool> has_children_;
};

}  // namespace

std::vector<Branch> branches(const Neighbourhoods& ring, std::span<const float> distance, float least) {
  assert(distance.size() == ring.size() && least >= 0.0f);
  return JoinTree(ring, distance, least).run();
}

}  // namespace osteon::geometry
