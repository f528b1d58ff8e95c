// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/document.h"

#include <array>
#include <cassert>
#include <cstring>

#include "osteon/base/error.h"

namespace osteon::io::gltf {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;
constexpr int kDeepestJson = 256;  // glTF itself needs about 8; deeper files are made to overflow stacks

std::uint32_t u32_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
  return static_cast<std::uint32_t>(bytes[offset]) | static_cast<std::uint32_t>(bytes[offset + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[offset + 2]) << 16 | static_cast<std::uint32_t>(bytes[offset + 3]) << 24;
}

// How deep brackets nest outside strings.
int nesting(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return deepest;
}

Json parse_json(const std::string& file, std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (nesting(text) > kDeepestJson) throw Error("{}: JSON nested deeper than {} levels", file, kDeepestJson);
  try {
    Json json = Json::parse(text);
    if (!json.is_object()) throw Error("{}: the JSON is no object", file);
    return json;
  } catch (const Json::exception& e) {
    throw Error("{}: malformed JSON: {}", file, e.what());
  }
}

struct Chunks {
  std::string_view json;
  std::span<const std::uint8_t> bin;
};

// The chunks of a GLB (specification, section 4.4).
Chunks split_glb(const std::string& file, std::span<const std::uint8_t> bytes, std::vector<std::string>& repairs) {
  if (bytes.size() < 20) throw Error("{}: truncated: {} bytes; a GLB has at least 20", file, bytes.size());
  const std::uint32_t version = u32_at(bytes, 4), length = u32_at(bytes, 8);
  if (version != 2) throw Error("{}: GLB version {}, expected 2", file, version);
  if (length > bytes.size()) throw Error("{}: truncated: {} bytes, but the header says {}", file, bytes.size(), length);
  if (length < bytes.size()) repairs.push_back(fmt::format("ignored {} bytes after the end of the GLB", bytes.size() - length));
  Chunks chunks;
  bool first = true;
  for (std::size_t at = 12; at + 8 <= length; first = false) {
    const std::uint32_t size = u32_at(bytes, at), type = u32_at(bytes, at + 4);
    if (size > length - at - 8) throw Error("{}: chunk at byte {} says {} bytes, but {} are left", file, at, size, length - at - 8);
    const auto content = bytes.subspan(at + 8, size);
    if (first && type != kJsonChunk) throw Error("{}: the first chunk is of type {:#x}, expected JSON", file, type);
    if (first) chunks.json = text_of(content);
    if (!first && type == kBinChunk && chunks.bin.empty()) chunks.bin = content;
    at += 8 + static_cast<std::size_t>(size);
  }
  return chunks;
}

Bytes decode_base64(std::string_view text, const std::string& where) {
  static constexpr auto kValues = [] {
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < alphabet.size(); ++i) values[static_cast<unsigned char>(alphabet[i])] = static_cast<std::int8_t>(i);
    return values;
  }();
  Bytes out;
  out.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const int value = kValues[static_cast<unsigned char>(c)];
    if (value < 0) throw Error("{}: not base64", where);
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if (++count % 4 != 1) out.push_back(static_cast<std::uint8_t>(bits >> (6 - 2 * ((count - 1) % 4))));
  }
  return out;
}

void require_version_2(const Document& document) {
  const std::string version = document.root().at("asset").at("version").text();
  if (!version.starts_with("2.")) throw Error("{}: glTF version {}, expected 2.x", document.path.filename().string(), version);
}

// Extensions that change where vertex data lie cannot be skipped; all others travel through untouched.
void require_readable_vertices(const Document& document) {
  for (const auto& list = document.root().find("extensionsRequired"); const Element& item : list ? list->items() : std::vector<Element>{})
    for (const char* compressed : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"})
      if (item.text() == compressed)
        throw Error("{}: {}: compressed vertices cannot be read; save the asset without compression", item.where(), compressed);
}

void fetch_buffers(Document& document, std::span<const std::uint8_t> bin) {
  for (const Element& buffer : document.all("buffers")) {
    const std::size_t length = buffer.at("byteLength").integer();
    const auto uri = buffer.find("uri");
    Bytes bytes;
    if (uri)
      bytes = fetch(document, uri->text(), uri->where());
    else if (document.buffers.empty() && bin.data())
      bytes.assign(bin.begin(), bin.end());
    else
      throw Error("{}: no uri and no binary chunk", buffer.where());
    if (bytes.size() < length) throw Error("{}: {} bytes, but byteLength says {}", buffer.where(), bytes.size(), length);
    bytes.resize(length);
    document.buffers.push_back(std::move(bytes));
  }
}

}  // namespace

std::vector<Element> Document::all(std::string_view key) const {
  const auto found = root().find(key);
  return found ? found->items() : std::vector<Element>{};
}

std::size_t Document::count(std::string_view key) const {
  const auto found = root().find(key);
  return found ? found->size() : 0;
}

Element Document::at(std::string_view key, std::size_t i) const {
  return Element(json.at(std::string(key)).at(i), fmt::format("{}: {}[{}]", path.filename().string(), key, i));
}

bool is_gltf(std::span<const std::uint8_t> bytes) {
  if (bytes.size() >= 4 && u32_at(bytes, 0) == kMagic) return true;
  const std::string_view head = text_of(bytes.first(std::min<std::size_t>(bytes.size(), 65536)));
  const std::size_t start = head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return start != std::string_view::npos && head[start] == '{';
}

Document parse(const std::filesystem::path& path, Bytes bytes, std::vector<std::string>& repairs) {
  const std::string file = path.filename().string();
  Chunks chunks{text_of(bytes), {}};
  if (bytes.size() >= 4 && u32_at(bytes, 0) == kMagic) chunks = split_glb(file, bytes, repairs);
  Document document{path, parse_json(file, chunks.json), {}};
  require_version_2(document);
  require_readable_vertices(document);
  fetch_buffers(document, chunks.bin);
  return document;
}

std::string decode_percent(std::string_view uri) {
  const auto hex = [](char c) {
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
  };
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0) {
      out += static_cast<char>(hex(uri[i + 1]) * 16 + hex(uri[i + 2]));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

Bytes fetch(const Document& document, const std::string& uri, const std::string& where) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
      throw Error("{}: a data URI that is not base64", where);
    return decode_base64(std::string_view(uri).substr(comma + 1), where);
  }
  const std::filesystem::path name = decode_percent(uri);
  if (uri.find("://") != std::string::npos || name.is_absolute()) throw Error("{}: '{}', expected a file beside the asset", where, uri);
  try {
    return read_file(document.path.parent_path() / name);
  } catch (const Error& e) {
    throw Error("{}: {}", where, e.what());
  }
}

void write_glb(const std::filesystem::path& path, const Document& document) {
  assert(document.buffers.size() <= 1);
  // Names of other formats may not be UTF-8.
  std::string json = document.json.dump(-1, ' ', false, Json::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  Bytes bin = document.buffers.empty() ? Bytes{} : document.buffers[0];
  bin.resize((bin.size() + 3) / 4 * 4);
  const std::size_t total = 12 + 8 + json.size() + (bin.empty() ? 0 : 8 + bin.size());
  if (total > 0xFFFFFFFFu) throw Error("{}: {} bytes do not fit a GLB", path.string(), total);
  const auto as_u32 = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  const std::array<std::uint32_t, 5> head{kMagic, 2, as_u32(total), as_u32(json.size()), kJsonChunk};
  const std::array<std::uint32_t, 2> bin_head{as_u32(bin.size()), kBinChunk};
  const auto raw = [](const auto& words) {
    return std::span(reinterpret_cast<const std::uint8_t*>(words.data()), words.size() * sizeof(words[0]));
  };
  std::vector<std::span<const std::uint8_t>> parts{raw(head), raw(json)};
  if (!bin.empty()) parts.insert(parts.end(), {raw(bin_head), bin});
  write_file(path, parts);
}

}  // namespace osteon::io::gltf
