// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/importer.h"

namespace osteon::io::stl {

// True if the bytes are a binary STL by their length, or begin as an ASCII one.
bool is_stl(std::span<const std::uint8_t> bytes);

// STL, binary or ASCII. Every triangle has three vertices of its own, as in the file.
Scene import(const File& file);

}  // namespace osteon::io::stl
