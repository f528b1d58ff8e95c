// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "commands.h"
#include "osteon/io/save.h"
#include "osteon/synth/character.h"

namespace osteon::app {
namespace {

struct SynthArguments {
  std::string kind;
  std::filesystem::path output;
  std::uint64_t seed = 1;
  bool bare = false;
  synth::CharacterOptions options;
};

void make(const SynthArguments& arguments) {
  Rig rig = synth::make_character(synth::kind_of(arguments.kind), arguments.seed, arguments.options);
  if (arguments.bare) {
    io::save_obj(arguments.output, rig.mesh);
  } else {
    io::Asset asset;
    asset.path = arguments.output;
    asset.mesh = std::move(rig.mesh);
    for (const std::string& change : io::save_glb(arguments.output, asset, rig.skeleton, rig.weights)) spdlog::warn(change);
  }
}

}  // namespace

void add_synth_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("synth", "Make a character with its exact rig from a seed");
  auto arguments = std::make_shared<SynthArguments>();
  std::vector<std::string> kinds;
  for (synth::Kind kind : synth::kKinds) kinds.emplace_back(synth::name(kind));
  command->add_option("kind", arguments->kind, "Kind of character")->required()->check(CLI::IsMember(kinds));
  command->add_option("--seed", arguments->seed, "Another seed gives another character")->capture_default_str();
  command->add_option("--cells", arguments->options.cells, "Fineness: cells along the longest side")
      ->check(CLI::Range(16, 2048))
      ->capture_default_str();
  command->add_flag("--bare", arguments->bare, "Only the mesh, as OBJ");
  command->add_option("-o,--output", arguments->output, "The GLB to write (with --bare: the OBJ)")->required();
  command->callback([arguments] { make(*arguments); });
}

}  // namespace osteon::app
