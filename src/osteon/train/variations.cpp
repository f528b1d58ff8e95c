// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/variations.h"

#include <utility>

namespace osteon::train {

Variations::Variations(std::function<Characters(std::uint64_t)> make, std::size_t echo) : make_(std::move(make)), echo_(echo) {}

Variations::Characters Variations::of(std::uint64_t step) {
  Characters shown;
  for (std::uint64_t age = 0; age < echo_; ++age) {
    const std::uint64_t before = age * kEchoStride;
    const Made share = before <= step ? made_at(step - before) : std::make_shared<const Characters>(make_(step * echo_ + age));
    shown.insert(shown.end(), share->begin(), share->end());
  }
  const std::uint64_t oldest = (echo_ - 1) * kEchoStride;
  const std::scoped_lock lock(mutex_);
  if (oldest <= step) made_.erase(step - oldest);
  return shown;
}

// Whoever asks first makes them, the others wait for it.
Variations::Made Variations::made_at(std::uint64_t step) {
  std::shared_future<Made> made;
  {
    const std::scoped_lock lock(mutex_);
    std::shared_future<Made>& known = made_[step];
    if (!known.valid())
      known = std::async(std::launch::deferred, [this, step] { return std::make_shared<const Characters>(make_(step * echo_)); }).share();
    made = known;
  }
  return made.get();
}

}  // namespace osteon::train
