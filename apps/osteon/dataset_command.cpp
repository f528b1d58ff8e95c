// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "../outputs.h"
#include "commands.h"
#include "motion_folder.h"
#include "osteon/base/parallel.h"
#include "osteon/dataset/manifest.h"
#include "osteon/dataset/pack.h"
#include "progress_line.h"
#include "rigged_file.h"

namespace osteon::app {
namespace {

constexpr std::uint64_t kSeed = 1;  // of the choice of poses

struct PrepareArguments {
  std::filesystem::path data, output, motions, clips_of;
  std::string split = "train";
  std::size_t poses = 8;
  dataset::PrepareOptions options;
};

// The character, or nothing, with a warning, where the file cannot be used: one bad file does not stop the others.
std::optional<dataset::PreparedCharacter> try_prepare(const dataset::ManifestEntry& entry, const dataset::PrepareOptions& options) {
  try {
    return dataset::prepare(load_rig(entry.file), entry.info, options);
  } catch (const Error& e) {
    spdlog::warn("{} left out: {}", entry.info.id, e.what());
    return std::nullopt;
  }
}

// What the characters' poses are taken from; nothing where no motions are given.
MotionFolder motions_for(const PrepareArguments& arguments) {
  if (arguments.motions.empty()) return {{}, "[]"};
  const auto& corpus = arguments.clips_of.empty() ? arguments.data : arguments.clips_of;
  return read_motions(arguments.motions, dataset::read_manifest(corpus, arguments.split), dataset::read_manifest(corpus, ""));
}

std::string joined(const std::string& sources, const std::string& more) {
  auto list = nlohmann::json::parse(sources);
  for (auto& source : nlohmann::json::parse(more)) list.push_back(std::move(source));
  return list.dump();
}

void prepare(const PrepareArguments& arguments) {
  check_late_outputs({}, {{"-o", arguments.output, ".safetensors"}});
  const auto entries = dataset::read_manifest(arguments.data, arguments.split);
  const MotionFolder motions = motions_for(arguments);
  std::vector<std::optional<dataset::PreparedCharacter>> results(entries.size());
  ProgressLine progress(fmt::format("preparing {}", arguments.split), entries.size());
  parallel_for(entries.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      results[i] = try_prepare(entries[i], arguments.options);
      Random random = Random(kSeed).fork(i);
      if (results[i]) results[i]->poses = dataset::motion_poses(*results[i], motions.library, arguments.poses, random);
      progress.advance();
    }
  });
  std::vector<dataset::PreparedCharacter> characters;
  std::vector<dataset::ManifestEntry> used;
  std::size_t posed = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    auto& result = results[i];
    if (!result) continue;
    used.push_back(entries[i]);
    for (const std::string& note : result->notes) spdlog::info("{}: {}", result->info.id, note);
    posed += result->poses.empty() ? 0 : 1;
    characters.push_back(std::move(*result));
  }
  if (characters.empty())
    throw Error("{}: none of the {} characters of split '{}' can be used", arguments.data.string(), entries.size(), arguments.split);
  dataset::save_characters(arguments.output, characters,
                           {{"split", arguments.split}, {"sources", joined(dataset::sources_of(used), motions.sources)}});
  spdlog::info("{} of {} characters written to {}", characters.size(), entries.size(), arguments.output.string());
  if (!arguments.motions.empty()) spdlog::info("{} of them with poses from motion", posed);
}

}  // namespace

void add_dataset_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("dataset", "Make training data from rigged characters");
  command->require_subcommand(1);
  CLI::App* prepare_command = command->add_subcommand("prepare", "Turn the characters of one split into one file for osteon-train");
  auto arguments = std::make_shared<PrepareArguments>();
  prepare_command->add_option("--data", arguments->data, "Folder with manifest.jsonl and the characters")->required();
  prepare_command->add_option("--split", arguments->split, "Which split of the manifest")->capture_default_str();
  prepare_command->add_option("-o,--output", arguments->output, "The safetensors file to write")->required();
  prepare_command->add_option("--vertices", arguments->options.working_mesh.target_vertices, "Vertices of the working mesh")
      ->capture_default_str();
  prepare_command
      ->add_option("--motions", arguments->motions, "Folder with clips, from which each character gets poses to be shown in (training.md)")
      ->check(CLI::ExistingDirectory);
  prepare_command->add_option("--poses", arguments->poses, "Poses of a character")->check(CLI::Range(1, 255))->capture_default_str();
  prepare_command
      ->add_option("--clips-of", arguments->clips_of,
                   "Folder with the manifest of the characters that the clips are of (default: --data); those of other splits are not used")
      ->check(CLI::ExistingDirectory);
  prepare_command->callback([arguments] { prepare(*arguments); });
}

}  // namespace osteon::app
