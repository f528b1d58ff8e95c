// SPDX-License-Identifier: Apache-2.0
#include "osteon/base/error.h"
#include "osteon/io/motion.h"

// BVH and the animations of a glTF. An Error is the right answer to a broken file; anything else that happens is a find.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    osteon::io::read_motion("/nowhere/fuzz.bvh", {data, data + size}, 6.0);
  } catch (const osteon::Error&) {
  }
  return 0;
}
