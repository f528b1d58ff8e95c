// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/branches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "osteon/base/random.h"
#include "osteon/geometry/union_find.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A sheet whose distance has three summits: heights 1, 0.8 and 0.75, the last two with a saddle at 0.7 between them.
struct Range {
  TriangleMesh mesh = shapes::sheet(100, 10);
  std::vector<float> height;

  Range() {
    for (const Vec3f& p : mesh.positions) {
      const float x = p.x();
      const auto slope = [&](float at, float top, float to, float low) {
        return low + (top - low) * (1.0f - std::abs(x - at) / std::abs(to - at));
      };
      float h = 0.0f;
      if (x <= 0.35f)
        h = x <= 0.2f ? slope(0.2f, 1.0f, 0.0f, 0.2f) : slope(0.2f, 1.0f, 0.35f, 0.3f);
      else if (x <= 0.6f)
        h = x <= 0.5f ? slope(0.5f, 0.8f, 0.35f, 0.3f) : slope(0.5f, 0.8f, 0.6f, 0.7f);
      else
        h = x <= 0.7f ? slope(0.7f, 0.75f, 0.6f, 0.7f) : slope(0.7f, 0.75f, 1.0f, 0.1f);
      height.push_back(h - 0.001f * std::abs(p.y() - 0.5f));
    }
  }
  std::vector<Branch> cut(float least) const { return branches(one_ring(mesh), height, least); }
  float x(const Branch& branch) const { return mesh.positions[branch.tip].x(); }
};

std::vector<const Branch*> ends(const std::vector<Branch>& list) {
  std::set<std::size_t> parents;
  for (const Branch& b : list)
    if (b.parent) parents.insert(*b.parent);
  std::vector<const Branch*> out;
  for (std::size_t k = 0; k < list.size(); ++k)
    if (!parents.contains(k)) out.push_back(&list[k]);
  return out;
}

TEST(Branches, summits_end_where_they_meet) {
  const Range range;
  const std::vector<Branch> found = range.cut(0.01f);
  const auto summits = ends(found);
  ASSERT_EQ(found.size(), 5u);
  ASSERT_EQ(summits.size(), 3u);
  const auto summit = [&](float at) {
    return **std::ranges::find_if(summits, [&](const Branch* b) { return std::abs(range.x(*b) - at) < 0.01f; });
  };
  const Branch highest = summit(0.2f), second = summit(0.5f), third = summit(0.7f);
  EXPECT_NEAR(highest.top, 1.0f, 1e-3f);
  EXPECT_NEAR(highest.base, 0.3f, 0.02f);
  EXPECT_NEAR(second.base, 0.7f, 0.02f);
  EXPECT_EQ(second.base, third.base);
  EXPECT_EQ(second.parent, third.parent);
  EXPECT_EQ(found[*second.parent].base, highest.base);
  EXPECT_EQ(found[*second.parent].parent, highest.parent);
  EXPECT_FALSE(found.back().parent);
  EXPECT_EQ(found.back().top, highest.top);
}

TEST(Branches, short_ones_belong_to_those_they_meet) {
  const Range range;
  EXPECT_EQ(ends(range.cut(0.07f)).size(), 2u);  // the third summit rises 0.05 above the saddle
  EXPECT_EQ(ends(range.cut(0.55f)).size(), 1u);  // the second 0.5
  EXPECT_EQ(range.cut(2.0f).size(), 1u);
}

TEST(Branches, every_reached_vertex_is_in_one_branch_and_above_its_base) {
  Range range;
  for (std::size_t v = 0; v < 40; ++v) range.height[v] = kInfinity;
  std::multiset<VertexId> seen;
  for (const Branch& branch : range.cut(0.01f))
    for (VertexId v : branch.vertices) {
      seen.insert(v);
      EXPECT_GE(range.height[index(v)], branch.base);
      EXPECT_LE(range.height[index(v)], branch.top);
    }
  EXPECT_EQ(seen.size(), range.height.size() - 40);
  EXPECT_EQ(std::set<VertexId>(seen.begin(), seen.end()).size(), seen.size());
}

// How many pieces are farther than the level, by joining them one by one.
std::size_t pieces_above(float level, const Neighbourhoods& ring, const std::vector<float>& height) {
  UnionFind joined(ring.size());
  std::set<std::uint32_t> pieces;
  for (std::uint32_t v = 0; v < ring.size(); ++v)
    for (std::uint32_t near : ring.of(v))
      if (height[v] > level && height[near] > level) joined.join(v, near);
  for (std::uint32_t v = 0; v < ring.size(); ++v)
    if (height[v] > level) pieces.insert(joined.find(v));
  return pieces.size();
}

TEST(Branches, at_every_level_there_are_as_many_as_pieces_of_the_surface) {
  const TriangleMesh mesh = shapes::merged(shapes::icosphere(3), shapes::shifted(shapes::sheet(12, 9), {3, 0, 0}));
  const Neighbourhoods ring = one_ring(mesh);
  Random random(5);
  std::vector<float> height;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) height.push_back(random.uniform());
  const std::vector<Branch> found = branches(ring, height, 0.0f);
  for (float level = 0.005f; level < 1.0f; level += 0.01f) {
    const auto alive = std::ranges::count_if(found, [&](const Branch& b) {
      const auto children_base = [&] {  // an inner branch begins where its children meet
        float begins = b.top;
        for (const Branch& child : found)
          if (child.parent && &found[*child.parent] == &b) begins = child.base;
        return begins;
      };
      return level < children_base() && (level >= b.base || !b.parent);
    });
    EXPECT_EQ(static_cast<std::size_t>(alive), pieces_above(level, ring, height)) << level;
  }
}

TEST(Branches, nothing_depends_on_vertices_that_no_path_reaches) {
  const TriangleMesh mesh = shapes::sheet(5, 5);
  EXPECT_TRUE(branches(one_ring(mesh), std::vector<float>(mesh.positions.size(), kInfinity), 0.1f).empty());
}

}  // namespace
}  // namespace osteon::geometry
