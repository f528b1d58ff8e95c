// SPDX-License-Identifier: Apache-2.0
#include "import_fuzz.h"
#include "osteon/io/other/assimp_import.h"

// Assimp itself crashes on malformed files (ReadFile of FBX does within seconds of fuzzing): what is tried here is that nothing of it gets
// out of the process that import() gives it, and that what it reads is made strict.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return osteon::io::fuzz_import("/nowhere/fuzz.fbx", data, size,
                                 [](const osteon::io::File& file) { return osteon::io::other::import(file); });
}
