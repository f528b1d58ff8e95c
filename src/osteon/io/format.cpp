// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/format.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "osteon/base/error.h"
#include "osteon/io/bytes.h"
#include "osteon/io/gltf/document.h"
#include "osteon/io/stl/stl.h"
#include "osteon/io/text_scanner.h"

namespace osteon::io {
namespace {

constexpr std::string_view kReadable = "expected GLB, glTF, OBJ, PLY, STL, FBX, DAE, 3DS or rig.txt";

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void refuse_unreadable(const std::filesystem::path& path, std::string_view head) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kKinds{{{"PXR-USDC", "USD"},
                                                                                 {"#usda", "USD"},
                                                                                 {"PK\x03\x04", "an archive (zip or usdz)"},
                                                                                 {"\x1F\x8B", "a compressed file (gzip)"},
                                                                                 {"BLENDER", "a Blender file; export it as GLB"},
                                                                                 {"\x89PNG", "a picture"},
                                                                                 {"\xFF\xD8\xFF", "a picture"},
                                                                                 {"%PDF", "a PDF"},
                                                                                 {"\x7F"
                                                                                  "ELF",
                                                                                  "a program"}}};
  for (const auto& [magic, kind] : kKinds)
    if (head.starts_with(magic)) throw Error("{}: {}; {}", path.filename().string(), kind, kReadable);
}

// The keyword of the first lines that are no comments.
std::optional<Format> format_of_text(std::string_view text) {
  TextScanner scan(text);
  for (int lines = 0; lines < 200 && !scan.at_end(); scan.next_line()) {
    const std::string_view word = scan.word();
    if (word.empty() || word.starts_with('#')) continue;
    for (const char* keyword : {"joints", "joint", "skin", "hier", "root"})
      if (word == keyword) return Format::rigtxt;
    for (const char* keyword : {"v", "vn", "vt", "f", "o", "g", "mtllib", "usemtl"})
      if (word == keyword) return Format::obj;
    ++lines;
  }
  return std::nullopt;
}

}  // namespace

Format format_of(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  const std::string_view text = text_of(bytes);
  refuse_unreadable(path, text);
  if (gltf::is_gltf(bytes)) return Format::gltf;
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return Format::ply;
  if (text.starts_with("Kaydara FBX Binary") || text.starts_with("; FBX")) return Format::other;
  if (stl::is_stl(bytes)) return Format::stl;
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return Format::obj;
  if (extension == ".ply") return Format::ply;
  if (extension == ".stl") return Format::stl;
  if (extension == ".glb" || extension == ".gltf" || extension == ".vrm") return Format::gltf;
  for (const char* other :
       {".fbx", ".dae", ".3ds", ".x",   ".lwo", ".lws", ".ms3d", ".md2", ".md3", ".md5mesh", ".smd", ".ase", ".ac",
        ".off", ".dxf", ".x3d", ".wrl", ".3mf", ".amf", ".ogex", ".cob", ".b3d", ".iqm",     ".pmx", ".bvh", ".mesh.xml"})
    if (extension == other) return Format::other;
  if (const auto format = format_of_text(text)) return *format;
  throw Error("{}: unknown format; {}", path.filename().string(), kReadable);
}

}  // namespace osteon::io
