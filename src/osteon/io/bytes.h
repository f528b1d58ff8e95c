// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace osteon::io {

using Bytes = std::vector<std::uint8_t>;

// The whole file. Throws Error if it cannot be read, is no regular file or is empty.
Bytes read_file(const std::filesystem::path& path);

// Writes beside `path` and renames, so that nobody ever sees half a file. Throws Error if that fails.
void write_file(const std::filesystem::path& path, std::span<const std::span<const std::uint8_t>> parts);

// Text in UTF-16 with a byte order mark as UTF-8; anything else as it is.
Bytes utf8_of(Bytes bytes);

inline std::string_view text_of(std::span<const std::uint8_t> bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

}  // namespace osteon::io
