// SPDX-License-Identifier: Apache-2.0
#include "motion_folder.h"

#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/dataset/retarget.h"
#include "osteon/io/motion.h"

namespace osteon::app {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double kPosesPerSecond = 6.0;

// A line of the manifest: of a GLB the character that it is of, of a BVH the rig.
struct Clip {
  fs::path file;
  bool is_own;
  std::string of;
  std::string licence, author, source;
};

std::vector<Clip> read_clips(const fs::path& folder) {
  const fs::path path = folder / "manifest.jsonl";
  std::ifstream file(path);
  if (!file) throw Error("{}: cannot be opened", path.string());
  std::vector<Clip> clips;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.empty()) continue;
    try {
      const json clip = json::parse(line);
      const bool is_own = clip.at("kind") == "glb";
      clips.push_back({folder / clip.at("file").get<std::string>(), is_own, clip.at(is_own ? "id" : "rig"), clip.at("licence"),
                       clip.at("author"), clip.at("source")});
    } catch (const json::exception& e) {
      throw Error("{}: line {}: {}", path.string(), number, e.what());
    }
  }
  return clips;
}

std::set<std::string> ids_of(const std::vector<dataset::ManifestEntry>& entries) {
  std::set<std::string> ids;
  for (const auto& entry : entries) ids.insert(entry.info.id);
  return ids;
}

// Own clips of `wanted` and bipeds' clips but of those that are held out.
std::vector<Clip> clips_to_read(const fs::path& folder, const std::set<std::string>& wanted, const std::set<std::string>& all) {
  std::vector<Clip> clips = read_clips(folder);
  std::erase_if(clips, [&](const Clip& clip) { return !wanted.contains(clip.of) && (clip.is_own || all.contains(clip.of)); });
  return clips;
}

// Compressed or not.
io::Bytes read_compressed(const fs::path& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw Error("{}: cannot be opened", path.string());
  io::Bytes bytes;
  io::Bytes part(1 << 16);
  int count = 0;
  while ((count = gzread(file.get(), part.data(), static_cast<unsigned>(part.size()))) > 0)
    bytes.insert(bytes.end(), part.begin(), part.begin() + count);
  if (count < 0) throw Error("{}: cannot be decompressed after {} bytes", path.string(), bytes.size());
  return bytes;
}

// The names of a rig's joints by those of dataset::kBipedJoints.
using JointNames = std::map<std::string, std::string>;

// Of each rig.
std::map<std::string, JointNames> read_joint_map(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw Error("{}: cannot be opened", path.string());
  std::map<std::string, JointNames> rigs;
  try {
    const json map = json::parse(file);
    for (const auto& [rig, about] : map.at("rigs").items())
      for (const auto& [common, name] : about.at("map").items())
        if (!name.is_null()) rigs[rig][common] = name.get<std::string>();
  } catch (const json::exception& e) {
    throw Error("{}: {}", path.string(), e.what());
  }
  return rigs;
}

// The joints of a biped alone, by their common names.
Motion as_biped(const Motion& motion, const JointNames& joints, const fs::path& file) {
  std::vector<std::size_t> kept;
  Motion out;
  for (const auto& [common, name] : joints) {
    const auto found = std::ranges::find(motion.names, name);
    if (found == motion.names.end()) throw Error("{}: has no joint '{}', expected by the joint map as {}", file.string(), name, common);
    kept.push_back(static_cast<std::size_t>(found - motion.names.begin()));
    out.names.push_back(common);
    out.rest.push_back(motion.rest[kept.back()]);
  }
  for (const auto& pose : motion.poses) {
    auto& of_kept = out.poses.emplace_back();
    for (const std::size_t j : kept) of_kept.push_back(pose[j]);
  }
  return out;
}

std::string sources_of(const std::vector<Clip>& clips) {
  std::map<std::tuple<std::string, std::string, std::string>, int> counts;
  for (const Clip& clip : clips) ++counts[{clip.source, clip.author, clip.licence}];
  json list = json::array();
  for (const auto& [origin, count] : counts) {
    const auto& [source, author, licence] = origin;
    list.push_back({{"source", source}, {"author", author}, {"licence", licence}, {"clips", count}});
  }
  return list.dump();
}

}  // namespace

MotionFolder read_motions(const fs::path& folder, const std::vector<dataset::ManifestEntry>& wanted,
                          const std::vector<dataset::ManifestEntry>& all) {
  const std::vector<Clip> clips = clips_to_read(folder, ids_of(wanted), ids_of(all));
  std::map<std::string, JointNames> joint_map;
  if (std::ranges::any_of(clips, [](const Clip& clip) { return !clip.is_own; }))
    joint_map = read_joint_map(folder / "biped" / "joint_map.json");
  std::vector<Motion> motions(clips.size());
  parallel_for(clips.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Clip& clip = clips[i];
      motions[i] = io::read_motion(clip.file, read_compressed(clip.file), kPosesPerSecond);
      if (clip.is_own) continue;
      const auto joints = joint_map.find(clip.of);
      if (joints == joint_map.end()) throw Error("{}: its rig '{}' is not in the joint map", clip.file.string(), clip.of);
      motions[i] = as_biped(motions[i], joints->second, clip.file);
    }
  });
  MotionFolder out{{}, sources_of(clips)};
  for (std::size_t i = 0; i < clips.size(); ++i) {
    if (clips[i].is_own)
      out.library.own[clips[i].of] = std::move(motions[i]);
    else
      out.library.bipeds.push_back(std::move(motions[i]));
  }
  return out;
}

}  // namespace osteon::app
