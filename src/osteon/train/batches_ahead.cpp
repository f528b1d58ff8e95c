// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/batches_ahead.h"

#include <numeric>

#include "osteon/base/parallel.h"
#include "osteon/train/step_profile.h"

namespace osteon::train {

BatchesAhead::BatchesAhead(std::function<dataset::Batch(std::uint64_t)> make, std::uint64_t first)
    : make_(std::move(make)), next_(first), block_size_(static_cast<std::size_t>(threads())) {
  if (block_size_ > 1) start(first);
}

dataset::Batch BatchesAhead::next() {
  if (used_ == block_.batches.size()) {
    block_ = block_size_ > 1 ? coming_.get() : make_block(next_);
    seconds_ += block_.seconds;
    used_ = 0;
    if (block_size_ > 1) start(next_ + block_size_);
  }
  ++next_;
  return std::move(block_.batches[used_++]);
}

BatchesAhead::Block BatchesAhead::make_block(std::uint64_t first) const {
  Block block{std::vector<dataset::Batch>(block_size_), 0.0};
  std::vector<double> seconds(block_size_);
  parallel_for(block_size_, 1, [&](std::size_t i, std::size_t) {
    const Stopwatch watch;
    block.batches[i] = make_(first + i);
    seconds[i] = watch.seconds();
  });
  block.seconds = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  return block;
}

void BatchesAhead::start(std::uint64_t first) {
  coming_ = std::async(std::launch::async, [this, first] { return make_block(first); });
}

}  // namespace osteon::train
