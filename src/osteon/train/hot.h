// SPDX-License-Identifier: Apache-2.0
#pragma once

// Marks an inner loop's function: one binary for all x86-64 machines, with the widest vectors that the one at hand has.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define OSTEON_HOT __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define OSTEON_HOT
#endif
