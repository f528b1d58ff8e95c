// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/weight_rows.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "osteon/base/parallel.h"

namespace osteon::skin {
namespace {

constexpr std::size_t kRowsPerTask = 512;
constexpr float kNothing = 1e-5f;  // weights below this are not worth a place

template <class Work>
void for_each_row(std::size_t rows, const Work& work) {
  parallel_for(rows, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) work(static_cast<VertexId>(v));
  });
}

}  // namespace

void merge(WeightRow& row) {
  std::ranges::stable_sort(row, {}, &Influence::joint);
  std::size_t n = 0;
  for (const Influence& i : row)
    if (n > 0 && row[n - 1].joint == i.joint)
      row[n - 1].weight += i.weight;
    else
      row[n++] = i;
  row.resize(n);
}

void normalize(WeightRow& row) {
  double sum = 0.0;
  for (const Influence& i : row) sum += static_cast<double>(i.weight);
  for (Influence& i : row) i.weight = static_cast<float>(static_cast<double>(i.weight) / sum);
}

WeightRows falloff_weights(const BoneDistances& distances, std::span<const Bone> bones, float size, const FalloffOptions& options) {
  WeightRows out(distances.size());
  const float margin = options.margin * size;
  for_each_row(out.size(), [&](VertexId v) {
    WeightRow& row = out[v];
    const float nearest = distances.of(v).front().distance + margin;
    for (const auto& [bone, distance] : distances.of(v)) {  // nearest first: of several bones of a joint the first counts
      const JointId joint = bones[bone].start;
      const float weight = std::pow(nearest / (distance + margin), options.power);
      if (weight > kNothing && std::ranges::find(row, joint, &Influence::joint) == row.end()) row.push_back({joint, weight});
    }
    std::ranges::sort(row, {}, &Influence::joint);
    normalize(row);
  });
  return out;
}

WeightRows nearest_weights(const BoneDistances& distances, std::span<const Bone> bones) {
  WeightRows out(distances.size());
  for_each_row(out.size(), [&](VertexId v) { out[v] = {{bones[distances.of(v).front().bone].start, 1.0f}}; });
  return out;
}

WeightRows smoothed(WeightRows rows, const geometry::Neighbourhoods& one_ring, int times) {
  assert(rows.size() == one_ring.size());
  for (int k = 0; k < times; ++k) {
    WeightRows next(rows.size());
    for_each_row(rows.size(), [&](VertexId v) {
      const auto neighbours = one_ring.of(index(v));
      WeightRow& row = next[v];
      row = rows[v];
      if (neighbours.empty()) return;
      for (Influence& i : row) i.weight *= 0.5f;
      const float share = 0.5f / static_cast<float>(neighbours.size());
      for (const std::uint32_t n : neighbours)
        for (const Influence& i : rows[VertexId{n}]) row.push_back({i.joint, share * i.weight});
      merge(row);
      std::erase_if(row, [](const Influence& i) { return !(i.weight > kNothing); });
      normalize(row);
    });
    rows = std::move(next);
  }
  return rows;
}

void prune(WeightRows& rows, float share, std::size_t most) {
  assert(most > 0);
  for_each_row(rows.size(), [&](VertexId v) {
    WeightRow& row = rows[v];
    std::ranges::stable_sort(row, std::greater(), &Influence::weight);
    row.resize(std::min(row.size(), most));
    const float least = share * row.front().weight;
    std::erase_if(row, [&](const Influence& i) { return i.weight < least; });
    std::ranges::sort(row, {}, &Influence::joint);
    normalize(row);
  });
}

SkinWeights to_skin_weights(const WeightRows& rows, const PerVertex<VertexId>& from_original) {
  SkinWeights out;
  for (const VertexId v : from_original) {
    const bool bound = out.append(rows[v]);
    assert(bound);
    static_cast<void>(bound);
  }
  return out;
}

}  // namespace osteon::skin
