// SPDX-License-Identifier: Apache-2.0
#pragma once

// Marks an inner loop's function: compiled for several instruction sets, of which the machine's is chosen at start-up.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define OSTEON_EVERY_CPU __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define OSTEON_EVERY_CPU
#endif
