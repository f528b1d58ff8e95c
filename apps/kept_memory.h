// SPDX-License-Identifier: Apache-2.0
#pragma once

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

namespace osteon::app {

// The tensors of one network are as large as those of the last: memory that is given back is asked for again, and every page of it then
// costs a fault. The C library gives back blocks of some megabytes at once; from here on it keeps them. For programs, not for libraries.
inline void keep_freed_memory() {
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest that is allowed
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

}  // namespace osteon::app
