// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/holdout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/base/random.h"
#include "osteon/dataset/solid_overlap.h"

namespace osteon::dataset {
namespace {

constexpr double kCopies = 0.95;  // RigNet, section 6

std::vector<Solid> solids_of(std::span<const PreparedCharacter> characters) {
  std::vector<Solid> solids(characters.size());
  parallel_for(characters.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) solids[i] = solid_of(characters[i].mesh);
  });
  return solids;
}

// Of each character the first one that it belongs together with.
std::vector<std::size_t> firsts(std::span<const PreparedCharacter> characters) {
  std::vector<std::size_t> above(characters.size());  // a forest: towards smaller indices
  std::iota(above.begin(), above.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (above[i] != i) i = above[i];
    return i;
  };
  const std::vector<Solid> solids = solids_of(characters);
  for (std::size_t i = 0; i < characters.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const std::size_t a = root(i), b = root(j);
      if (a != b && (characters[i].info.group == characters[j].info.group || overlap(solids[i], solids[j]) > kCopies))
        above[std::max(a, b)] = std::min(a, b);
    }
  std::vector<std::size_t> out(characters.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = root(i);
  return out;
}

}  // namespace

Holdout hold_out(std::span<const PreparedCharacter> characters, double share, std::uint64_t seed) {
  std::map<std::size_t, std::vector<std::size_t>> by_first;
  const std::vector<std::size_t> first = firsts(characters);
  for (std::size_t i = 0; i < first.size(); ++i) by_first[first[i]].push_back(i);
  if (by_first.size() < 2)
    throw Error("{} characters, all of one group or copies of one another; expected two different ones, to learn from and to validate with",
                characters.size());
  std::vector<std::vector<std::size_t>> clusters;
  for (auto& [unused, members] : by_first) clusters.push_back(std::move(members));
  Random random(seed);
  random.shuffle(std::span(clusters));
  const auto wanted = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(share * static_cast<double>(characters.size()))));

  Holdout out;
  std::vector<std::vector<std::size_t>> too_large;
  for (auto& cluster : clusters) {
    const bool is_needed = out.train.empty() && &cluster == &clusters.back();  // to learn from
    const bool fits = !is_needed && out.validation.size() + cluster.size() <= wanted;
    auto& to = fits ? out.validation : out.train;
    to.insert(to.end(), cluster.begin(), cluster.end());
    if (!fits) too_large.push_back(std::move(cluster));
  }
  if (out.validation.empty()) {  // all are larger than wanted
    out.validation = *std::ranges::min_element(too_large, {}, &std::vector<std::size_t>::size);
    std::erase_if(out.train, [&](std::size_t i) { return std::ranges::find(out.validation, i) != out.validation.end(); });
  }
  std::ranges::sort(out.train);
  std::ranges::sort(out.validation);
  return out;
}

}  // namespace osteon::dataset
