// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace osteon::geometry {

// Items grouped by a small integer key, in their own order within a group.
template <class Item>
struct Buckets {
  std::vector<std::uint32_t> offsets;  // keys + 1
  std::vector<Item> items;

  std::span<Item> of(std::size_t key) { return std::span(items).subspan(offsets[key], offsets[key + 1] - offsets[key]); }
  std::span<const Item> of(std::size_t key) const { return std::span(items).subspan(offsets[key], offsets[key + 1] - offsets[key]); }
  std::size_t size() const { return offsets.size() - 1; }
};

// Counting sort. `visit` calls its argument as put(key, item) for every item, keys in 0..keys-1; it is run twice and must do the same both
// times.
template <class Item, class Visit>
Buckets<Item> bucketed(std::size_t keys, const Visit& visit) {
  Buckets<Item> out;
  out.offsets.assign(keys + 2, 0);
  visit([&](std::size_t key, const Item&) { ++out.offsets[key + 2]; });
  for (std::size_t k = 2; k < out.offsets.size(); ++k) out.offsets[k] += out.offsets[k - 1];
  out.items.resize(out.offsets.back());
  visit([&](std::size_t key, const Item& item) { out.items[out.offsets[key + 1]++] = item; });
  out.offsets.pop_back();  // each start has moved to its end, which is where the next one starts
  return out;
}

}  // namespace osteon::geometry
