// SPDX-License-Identifier: Apache-2.0
#include "osteon/rig/skin_weights.h"

#include <algorithm>
#include <cmath>

#include "osteon/base/error.h"

namespace osteon {

std::size_t SkinWeights::max_influences() const {
  std::size_t most = 0;
  for (std::size_t v = 0; v < size(); ++v) most = std::max<std::size_t>(most, offsets_[v + 1] - offsets_[v]);
  return most;
}

bool SkinWeights::append(std::span<const Influence> row, std::size_t limit) {
  std::vector<Influence> kept;
  for (const Influence& i : row)
    if (i.weight > 0.0f && std::isfinite(i.weight)) kept.push_back(i);
  std::sort(kept.begin(), kept.end(), [](const Influence& a, const Influence& b) { return a.joint < b.joint; });
  std::size_t n = 0;
  for (const Influence& i : kept) {
    if (n > 0 && kept[n - 1].joint == i.joint)
      kept[n - 1].weight += i.weight;
    else
      kept[n++] = i;
  }
  kept.resize(n);
  std::stable_sort(kept.begin(), kept.end(), [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
  kept.resize(std::min(n, limit));
  double sum = 0.0;
  for (const Influence& i : kept) sum += static_cast<double>(i.weight);
  for (Influence& i : kept) i.weight = static_cast<float>(static_cast<double>(i.weight) / sum);
  std::erase_if(kept, [](const Influence& i) { return !(i.weight > 0.0f); });  // underflow of a denormal share
  influences_.insert(influences_.end(), kept.begin(), kept.end());
  offsets_.push_back(static_cast<std::uint32_t>(influences_.size()));
  return !kept.empty();
}

void validate(const SkinWeights& weights, std::size_t vertices, std::size_t joints) {
  if (weights.size() != vertices) throw Error("skin weights for {} vertices, but the mesh has {}", weights.size(), vertices);
  for (VertexId v : ids<VertexId>(vertices)) {
    const auto row = weights[v];
    if (row.empty()) throw Error("vertex {} has no skin weight", index(v));
    double sum = 0.0;
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (index(row[k].joint) >= joints) throw Error("vertex {} is bound to joint {}, but there are {} joints", index(v), index(row[k].joint), joints);
      if (!(row[k].weight > 0.0f)) throw Error("vertex {} has the weight {} for joint {}; expected > 0", index(v), row[k].weight, index(row[k].joint));
      if (k > 0 && row[k].weight > row[k - 1].weight) throw Error("vertex {} has weights that are not sorted", index(v));
      for (std::size_t l = 0; l < k; ++l)
        if (row[l].joint == row[k].joint) throw Error("vertex {} has joint {} twice", index(v), index(row[k].joint));
      sum += static_cast<double>(row[k].weight);
    }
    if (std::abs(sum - 1.0) > 1e-5) throw Error("vertex {} has weights that sum to {}; expected 1", index(v), sum);
  }
}

}  // namespace osteon
