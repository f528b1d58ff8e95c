// SPDX-License-Identifier: Apache-2.0
#include "characters.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>

#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/io/load.h"

namespace osteon::app {
namespace {

namespace fs = std::filesystem;

bool is_gltf(const fs::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".glb" || extension == ".gltf";
}

// Each file is a group of its own; copies are found later, by their shape.
std::vector<dataset::ManifestEntry> every_file(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw Error("{}: not a folder; expected one with rigged characters", folder.string());
  std::vector<dataset::ManifestEntry> entries;
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder)) {
    if (!file.is_regular_file() || !is_gltf(file.path())) continue;
    const std::string id = file.path().lexically_relative(folder).generic_string();
    entries.push_back({{id, id, "own"}, file.path(), "train", "not stated", "not stated", folder.string()});
  }
  if (entries.empty()) throw Error("{}: found no .glb or .gltf file, expected rigged characters", folder.string());
  std::ranges::sort(entries, {}, [](const auto& entry) { return entry.info.id; });
  return entries;
}

std::vector<dataset::ManifestEntry> entries_of(const fs::path& folder) {
  if (!fs::exists(folder / "manifest.jsonl")) return every_file(folder);
  auto entries = dataset::read_manifest(folder, "");
  std::erase_if(entries, [](const auto& entry) { return entry.split != "train" && entry.split != "val"; });
  return entries;
}

// Ids are kept as JSON, which is UTF-8.
void check_name(const dataset::ManifestEntry& entry) {
  try {
    (void)nlohmann::json(entry.info.id).dump();
  } catch (const nlohmann::json::exception&) {
    throw Error("{}: its name is not in UTF-8; rename it", entry.file.string());
  }
}

dataset::PreparedCharacter prepared(const dataset::ManifestEntry& entry) {
  check_name(entry);
  io::Asset asset = io::load(entry.file);
  if (!asset.skeleton || !asset.weights) throw Error("{}: has no skeleton with skin weights", entry.file.string());
  return dataset::prepare({std::move(asset.mesh), std::move(*asset.skeleton), std::move(*asset.weights)}, entry.info);
}

}  // namespace

Characters read_characters(const fs::path& folder, const std::function<void(double)>& progress) {
  const std::vector<dataset::ManifestEntry> entries = entries_of(folder);
  std::vector<std::optional<dataset::PreparedCharacter>> usable(entries.size());
  std::vector<std::string> errors(entries.size());
  std::atomic<std::size_t> done = 0;
  parallel_for(entries.size(), 1, [&](std::size_t i, std::size_t) {
    try {
      usable[i] = prepared(entries[i]);
    } catch (const Error& e) {
      errors[i] = e.what();
    }
    progress(static_cast<double>(++done) / static_cast<double>(entries.size()));
  });

  Characters out;
  std::vector<dataset::ManifestEntry> used;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!usable[i]) {
      out.left_out.push_back(errors[i]);
      continue;
    }
    used.push_back(entries[i]);
    (entries[i].split == "val" ? out.validation : out.train).push_back(std::move(*usable[i]));
  }
  if (used.size() < 2)
    throw Error("{}: {} of {} characters can be used, expected two at least: to learn from and to validate with{}{}", folder.string(),
                used.size(), entries.size(), out.left_out.empty() ? "" : "; left out:\n  ", fmt::join(out.left_out, "\n  "));
  out.sources = dataset::sources_of(used);
  return out;
}

}  // namespace osteon::app
