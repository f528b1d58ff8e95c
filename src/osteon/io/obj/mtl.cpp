// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/obj/mtl.h"

#include <algorithm>

#include "osteon/base/error.h"
#include "osteon/io/text_scanner.h"

namespace osteon::io::obj {
namespace {

// Files come from all systems; options such as "-s 1 1 1" stand before the name.
std::filesystem::path texture_path(const std::filesystem::path& folder, TextScanner& scan) {
  std::string name(scan.rest());
  if (name.starts_with('-')) name = name.substr(name.find_last_of(" \t") + 1);
  std::replace(name.begin(), name.end(), '\\', '/');
  return name.empty() ? std::filesystem::path() : folder / name;
}

float between_0_and_1(float value, float otherwise) { return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : otherwise; }

// What a bump map holds: heights, says the format; normals, where Blender wrote it.
enum class Bumps { heights, normals };

bool is_bump(std::string_view keyword) { return keyword == "bump" || keyword == "map_Bump" || keyword == "map_bump"; }

bool holds_normals(std::string_view keyword, Bumps bumps) {
  return keyword == "norm" || keyword == "map_Kn" || (bumps == Bumps::normals && is_bump(keyword));
}

bool is_texture(std::string_view keyword) {
  return keyword.starts_with("map_") || is_bump(keyword) || keyword == "disp" || keyword == "decal" || keyword == "refl";
}

}  // namespace

void read_mtl(const std::filesystem::path& folder, const std::string& name, std::map<std::string, Scene::Material>& materials,
              std::vector<std::string>& repairs) {
  Bytes bytes;
  try {
    std::string portable = name;
    std::replace(portable.begin(), portable.end(), '\\', '/');
    bytes = read_file(folder / portable);
  } catch (const Error& e) {
    repairs.push_back(fmt::format("materials left out: {}", e.what()));
    return;
  }
  const Bumps bumps = text_of(bytes).starts_with("# Blender") ? Bumps::normals : Bumps::heights;
  std::map<std::string, std::size_t> left_out;
  Scene::Material* current = nullptr;
  for (TextScanner scan(text_of(bytes)); !scan.at_end(); scan.next_line()) {
    const std::string_view keyword = scan.word();
    if (keyword == "newmtl") {
      const std::string material(scan.rest());
      current = &materials[material];
      current->name = material;
    } else if (!current) {
      continue;
    } else if (keyword == "Kd") {
      for (int c = 0; c < 3; ++c) current->colour[c] = between_0_and_1(scan.number(), 0.8f);
    } else if (keyword == "d") {
      current->colour[3] = between_0_and_1(scan.number(), 1.0f);
    } else if (keyword == "Tr") {
      current->colour[3] = 1.0f - between_0_and_1(scan.number(), 0.0f);
    } else if (keyword == "Pm") {
      current->metallic = between_0_and_1(scan.number(), 0.0f);
    } else if (keyword == "Pr") {
      current->roughness = between_0_and_1(scan.number(), 1.0f);
    } else if (keyword == "map_Kd") {
      current->base.file = texture_path(folder, scan);
    } else if (holds_normals(keyword, bumps)) {
      current->normals.file = texture_path(folder, scan);
    } else if (is_texture(keyword)) {
      ++left_out[std::string(keyword)];
    }
  }
  for (const auto& [keyword, count] : left_out) repairs.push_back(fmt::format("left out the {} textures of {} materials", keyword, count));
}

}  // namespace osteon::io::obj
