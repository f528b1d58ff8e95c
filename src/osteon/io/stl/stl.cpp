// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/stl/stl.h"

#include <cstring>

#include "osteon/base/error.h"
#include "osteon/io/text_scanner.h"

namespace osteon::io::stl {
namespace {

constexpr std::size_t kHeader = 84, kTriangle = 50;

std::size_t promised_triangles(std::span<const std::uint8_t> bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  return count;
}

// Binary files may begin with "solid" too: then their length tells.
bool is_binary(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeader) return false;
  if (bytes.size() == kHeader + kTriangle * promised_triangles(bytes)) return true;
  const std::string_view head = text_of(bytes.first(std::min<std::size_t>(bytes.size(), 1024)));
  return !(head.starts_with("solid") && head.find("facet") != std::string_view::npos);
}

void add_triangle(Scene::Mesh& mesh) {
  const auto n = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.faces.push_back({VertexId{n - 3}, VertexId{n - 2}, VertexId{n - 1}});
}

Scene::Mesh read_binary(const File& file) {
  Scene::Mesh mesh;
  const std::size_t promised = promised_triangles(file.bytes), there = (file.bytes.size() - kHeader) / kTriangle;
  const std::size_t count = std::min(promised, there);
  if (promised > there) file.repairs.push_back(fmt::format("the file ends early; read {} of {} triangles", there, promised));
  mesh.positions.reserve(3 * count);
  mesh.faces.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    float corners[9];
    std::memcpy(corners, file.bytes.data() + kHeader + kTriangle * t + 12, sizeof corners);  // after the normal
    for (int k = 0; k < 3; ++k) mesh.positions.emplace_back(corners[3 * k], corners[3 * k + 1], corners[3 * k + 2]);
    add_triangle(mesh);
  }
  return mesh;
}

Scene::Mesh read_ascii(const File& file) {
  Scene::Mesh mesh;
  std::size_t corners = 0, incomplete = 0;
  for (TextScanner scan(file.text()); !scan.at_end(); scan.next_line()) {
    const std::string_view keyword = scan.word();
    if (keyword == "vertex") {
      const float x = scan.number(), y = scan.number(), z = scan.number();
      mesh.positions.emplace_back(x, y, z);
      if (++corners == 3) add_triangle(mesh);
    } else if (keyword == "outer" || keyword == "endfacet" || keyword == "facet") {
      if (corners != 0 && corners != 3) {
        ++incomplete;
        mesh.positions.resize(mesh.faces.size() * 3);
      }
      corners = 0;
    }
  }
  if (corners != 0 && corners != 3) ++incomplete;
  mesh.positions.resize(mesh.faces.size() * 3);
  if (incomplete > 0) file.repairs.push_back(fmt::format("dropped {} facets without exactly three vertices", incomplete));
  return mesh;
}

}  // namespace

bool is_stl(std::span<const std::uint8_t> bytes) {
  if (bytes.size() >= kHeader && bytes.size() == kHeader + kTriangle * promised_triangles(bytes)) return true;
  const std::string_view head = text_of(bytes.first(std::min<std::size_t>(bytes.size(), 1024)));
  return head.starts_with("solid") && head.find("facet") != std::string_view::npos;
}

Scene import(const File& file) {
  if (is_binary(file.bytes)) return scene_of(read_binary(file));
  if (!file.text().starts_with("solid")) throw Error("neither a binary nor an ASCII STL");
  return scene_of(read_ascii(file));
}

}  // namespace osteon::io::stl
