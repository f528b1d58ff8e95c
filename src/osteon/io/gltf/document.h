// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "osteon/io/bytes.h"
#include "osteon/io/gltf/element.h"

namespace osteon::io::gltf {

// A glTF 2.0 asset: its JSON as it was, and the bytes of its buffers.
struct Document {
  std::filesystem::path path;  // for messages, and to find images beside it
  Json json = Json::object();
  std::vector<Bytes> buffers;  // as many as json["buffers"], each with at least its byteLength

  Element root() const { return Element(json, path.filename().string()); }
  std::vector<Element> all(std::string_view key) const;  // items of a top-level array; none if it is absent
  std::size_t count(std::string_view key) const;
  Element at(std::string_view key, std::size_t i) const;  // pre: i < count(key)
};

// True if the bytes look like a GLB, or like the JSON of a glTF.
bool is_gltf(std::span<const std::uint8_t> bytes);

// Reads a GLB or the JSON of a glTF with the buffers that it names (files beside it, data URIs). Repairs are appended to `repairs`.
// Throws Error for what is no glTF 2.0, is truncated, needs an extension that changes how vertices are stored and that we do not know,
// or lacks a buffer.
Document parse(const std::filesystem::path& path, Bytes bytes, std::vector<std::string>& repairs);

// The text behind the percent signs of a URI: "a%20b" is "a b".
std::string decode_percent(std::string_view uri);

// The bytes behind a URI: a data: URI, or a file named relative to the document. Throws Error naming `where`.
Bytes fetch(const Document& document, const std::string& uri, const std::string& where);

// Writes a GLB. Pre: at most one buffer, without a uri.
void write_glb(const std::filesystem::path& path, const Document& document);

}  // namespace osteon::io::gltf
