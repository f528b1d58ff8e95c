// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/gltf/document.h"

namespace osteon::io::gltf {

// Joins all buffers to one, and moves images that lie in files or data URIs into it, so that the document can be written as one GLB.
// Images that cannot be read keep their URI; `changes` says so.
void join_buffers(Document& document, std::vector<std::string>& changes);

// "image/png" and the like by the first bytes; empty if unknown.
std::string image_type(std::span<const std::uint8_t> bytes);

}  // namespace osteon::io::gltf
