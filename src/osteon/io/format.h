// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace osteon::io {

enum class Format { gltf, obj, ply, stl, rigtxt, other };  // other: left to Assimp

// Told by the content where that is sure, else by the extension. Throws Error for formats known not to be readable (USD, archives,
// pictures) and for files that nothing speaks for.
Format format_of(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace osteon::io
