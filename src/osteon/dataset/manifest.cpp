// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/manifest.h"

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "osteon/base/error.h"

namespace osteon::dataset {
namespace {

ManifestEntry parse_line(const std::string& line, const std::filesystem::path& folder) {
  const auto json = nlohmann::json::parse(line);
  const auto text = [&](const char* key) {
    if (!json.is_object() || !json.contains(key)) throw Error("has no \"{}\", expected one", key);
    if (!json[key].is_string()) throw Error("\"{}\": found {}, expected a text", key, json[key].dump());
    return json[key].get<std::string>();
  };
  const std::string category = text("category");
  return {{text("id"), text("group"), category.substr(0, category.find('/'))},
          folder / text("file"),
          text("split"),
          text("licence"),
          text("author"),
          text("source_repo")};
}

}  // namespace

std::vector<ManifestEntry> read_manifest(const std::filesystem::path& folder, const std::string& split) {
  const std::filesystem::path path = folder / "manifest.jsonl";
  std::ifstream file(path);
  if (!file) throw Error("{}: cannot be opened", path.string());
  std::vector<ManifestEntry> entries;
  std::map<std::string, int> lines;  // of the ids
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      ManifestEntry entry = parse_line(line, folder);
      const auto [first, is_new] = lines.emplace(entry.info.id, number);
      if (!is_new) throw Error("the id '{}' is that of line {} too, expected each once", entry.info.id, first->second);
      if (split.empty() || entry.split == split) entries.push_back(std::move(entry));
    } catch (const std::exception& e) {
      throw Error("{}: line {}: {}", path.string(), number, e.what());
    }
  }
  if (entries.empty()) throw Error("{}: no character has the split '{}'; expected train, val or test", path.string(), split);
  return entries;
}

std::string sources_of(const std::vector<ManifestEntry>& entries) {
  std::map<std::tuple<std::string, std::string, std::string>, int> counts;
  for (const ManifestEntry& e : entries) ++counts[{e.source, e.author, e.licence}];
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [origin, count] : counts) {
    const auto& [source, author, licence] = origin;
    list.push_back({{"source", source}, {"author", author}, {"licence", licence}, {"characters", count}});
  }
  return list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);  // a folder's name may be no UTF-8
}

}  // namespace osteon::dataset
