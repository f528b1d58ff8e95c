// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace osteon::train {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

// Where the time of training went, in seconds summed over its steps. forward, backward, optimiser and waiting are those of the clock and
// make up the steps; products (inside forward and backward) and making (of batches; inside waiting where nothing is made ahead) are summed
// over the threads that worked on them.
struct StepProfile {
  std::int64_t steps = 0;
  double waiting = 0.0;  // for the batch
  double forward = 0.0, backward = 0.0, optimiser = 0.0;
  double making = 0.0;
  double products = 0.0;         // matrix products of the fused engine (gemm.h)
  double multiplications = 0.0;  // of numbers, in these

  double all() const { return waiting + forward + backward + optimiser; }
};

}  // namespace osteon::train
