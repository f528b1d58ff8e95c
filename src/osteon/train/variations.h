// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "osteon/dataset/batch.h"

namespace osteon::train {

// The changed characters that a batch shows, and that it shares with others: each is made once and shown in `echo` batches, `kEchoStride`
// steps apart, so that bending and measuring characters anew need not be as fast as learning from them. After Choi et al., "Faster Neural
// Network Training with Data Echoing", 2019; we echo before the last augmentation, as it recommends: every batch places them anew.
// What a step shows depends on its number alone, so a resumed run goes on as if it had not been stopped.
class Variations {
 public:
  using Characters = std::vector<std::shared_ptr<const dataset::Example>>;
  static constexpr std::uint64_t kEchoStride = 16;  // more than there are batches in the making at once on most machines

  // make(stream): the characters of one share of a batch; different streams give different ones. Must depend on nothing that changes.
  Variations(std::function<Characters(std::uint64_t stream)> make, std::size_t echo);

  // The characters of a step: new ones, and those that were new 1, 2, ... echo - 1 strides before (all new where there was no such step).
  // May be called by several threads at once. Throws what make() threw.
  Characters of(std::uint64_t step);

 private:
  using Made = std::shared_ptr<const Characters>;
  Made made_at(std::uint64_t step);

  std::function<Characters(std::uint64_t)> make_;
  std::size_t echo_;
  std::mutex mutex_;
  std::map<std::uint64_t, std::shared_future<Made>> made_;  // by step, until they were shown for the last time
};

}  // namespace osteon::train
