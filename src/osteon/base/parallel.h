// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace osteon {

// Threads that parallel_for uses: the number of cores unless set, or as many as the system gives. Pre for set_threads: n >= 1, no
// parallel_for is running.
int threads();
void set_threads(int n);

// Calls body(begin, end) for consecutive ranges of at most `grain` items that together cover 0..n-1, on all threads.
// The ranges depend on n and grain only, never on the thread count: a result put together range by range is the same for any
// number of threads. Nested calls run in the calling thread. The first exception thrown by body is rethrown here.
void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace osteon
