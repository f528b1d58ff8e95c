// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "osteon/io/gltf/document.h"

namespace osteon::io::gltf {

// The top-level arrays whose items can become superfluous when a rig is replaced.
enum class Kind { nodes, meshes, skins, accessors, buffer_views };
const char* key_of(Kind kind);

// True if all extensions that the document uses are known not to refer to items by index where visit_references() does not look.
bool references_are_known(const Document& document);

// Which items of an array something refers to.
std::vector<bool> used_items(const Document& document, Kind kind);

// Removes the marked items of an array and renumbers every reference; references to removed items go too.
void remove_items(Document& document, Kind kind, const std::vector<bool>& remove);

// Lays out the buffer anew with the bytes of the remaining buffer views only. Pre: one buffer.
void repack_buffer(Document& document);

}  // namespace osteon::io::gltf
