// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "../outputs.h"
#include "commands.h"
#include "contact_sheet.h"
#include "osteon/io/save.h"
#include "osteon/synth/character.h"
#include "osteon/synth/garments.h"

namespace osteon::app {
namespace {

struct SynthArguments {
  std::string kind;
  std::filesystem::path output;
  std::uint64_t seed = 1;
  bool bare = false, dressed = false;
  std::size_t sheet = 0;  // characters of each kind on a contact sheet; 0: none
  synth::CharacterOptions options;
};

// Characters of one kind, or of all where none is given, from the seed on.
void make_sheet(const SynthArguments& arguments) {
  std::vector<Rig> rigs;
  for (synth::Kind kind : synth::kKinds)
    if (arguments.kind.empty() || kind == synth::kind_of(arguments.kind))
      for (std::uint64_t i = 0; i < arguments.sheet; ++i)
        rigs.push_back(synth::make_character(kind, arguments.seed + i, arguments.options));
  render::save_png(arguments.output, contact_sheet(rigs));
}

void make(const SynthArguments& arguments) {
  check_outputs({}, {{"-o", arguments.output, arguments.sheet > 0 ? ".png" : arguments.bare ? ".obj" : ".glb"}});
  if (arguments.sheet > 0) return make_sheet(arguments);
  if (arguments.kind.empty()) throw Error("synth: expected a kind of character, or --sheet for all kinds");
  Rig rig = synth::make_character(synth::kind_of(arguments.kind), arguments.seed, arguments.options);
  if (arguments.dressed) rig = synth::dressed(rig, arguments.seed).rig;
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
  command->add_option("kind", arguments->kind, "Kind of character")->check(CLI::IsMember(kinds));
  command->add_option("--seed", arguments->seed, "Another seed gives another character")->capture_default_str();
  command->add_option("--cells", arguments->options.cells, "Fineness: cells along the longest side")
      ->check(CLI::Range(16, 2048))
      ->capture_default_str();
  command->add_flag_callback(
      "--smooth", [arguments] { arguments->options.finish = synth::Finish::Smooth; },
      "Small faces everywhere; otherwise the seed may choose few large ones");
  command->add_flag("--dressed", arguments->dressed, "With a skirt, a cloak or wide sleeves (biped only)");
  command->add_flag("--bare", arguments->bare, "Only the mesh, as OBJ");
  command->add_option("--sheet", arguments->sheet, "Only a picture of so many characters of the kind, or of each kind where none is given");
  command->add_option("-o,--output", arguments->output, "The GLB to write (with --bare: the OBJ; with --sheet: the PNG)")->required();
  command->callback([arguments] { make(*arguments); });
}

}  // namespace osteon::app
