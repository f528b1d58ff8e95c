// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <vector>

#include "osteon/dataset/batch.h"

namespace osteon::train {

// The batches of the steps from `first` on, in their order, made while others are trained on: a block of them at a time, each by one
// thread. On a machine with one core, or with set_threads(1), each is made when it is asked for. The batches are the same either way.
class BatchesAhead {
 public:
  // make(step): the batch of a step; must depend on nothing that changes meanwhile.
  BatchesAhead(std::function<dataset::Batch(std::uint64_t step)> make, std::uint64_t first);
  BatchesAhead(const BatchesAhead&) = delete;
  BatchesAhead& operator=(const BatchesAhead&) = delete;

  // The next batch; waits for it where need be. Throws what make() threw.
  dataset::Batch next();

  double seconds_of_making() const { return seconds_; }  // summed over the threads, of the batches given out so far

 private:
  struct Block {
    std::vector<dataset::Batch> batches;
    double seconds;
  };
  Block make_block(std::uint64_t first) const;
  void start(std::uint64_t first);

  std::function<dataset::Batch(std::uint64_t)> make_;
  std::uint64_t next_;
  std::size_t block_size_, used_ = 0;
  Block block_;
  double seconds_ = 0.0;
  std::future<Block> coming_;  // the last member: its end waits for the thread that reads the others
};

}  // namespace osteon::train
