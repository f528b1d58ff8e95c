// SPDX-License-Identifier: Apache-2.0
#include "import_fuzz.h"
#include "osteon/io/obj/obj.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return osteon::io::fuzz_import("/nowhere/fuzz.obj", data, size,
                                 [](const osteon::io::File& file) { return osteon::io::obj::import(file); });
}
