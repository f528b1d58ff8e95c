// SPDX-License-Identifier: Apache-2.0
#include "import_fuzz.h"
#include "osteon/io/gltf/import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return osteon::io::fuzz_import("/nowhere/fuzz.glb", data, size, [](const osteon::io::File& file) {
    const auto document = osteon::io::gltf::parse(file.path, {file.bytes.begin(), file.bytes.end()}, file.repairs);
    return osteon::io::gltf::import_scene(document, file.repairs).scene;
  });
}
