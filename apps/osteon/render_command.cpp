// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "../outputs.h"
#include "commands.h"
#include "load_options.h"
#include "osteon/io/texture_files.h"
#include "preview.h"

namespace osteon::app {
namespace {

struct RenderArguments {
  std::filesystem::path input, output;
  std::string pose = "1";
  std::pair<int, int> size{1600, 800};
  io::LoadOptions load;
};

void render(const RenderArguments& arguments) {
  check_outputs({arguments.input}, {{"-o", arguments.output, ".png"}});
  const io::Asset asset = io::load(arguments.input, arguments.load);
  check_outputs(io::texture_files(asset), {{"-o", arguments.output, ".png"}});
  for (const auto& repairs : {asset.repairs, asset.rig_repairs})
    for (const std::string& repair : repairs) spdlog::warn("{}: {}", arguments.input.string(), repair);
  save_preview(arguments.output, asset.mesh, asset.skeleton ? &*asset.skeleton : nullptr, asset.weights ? &*asset.weights : nullptr,
               parse_pose(arguments.pose), {arguments.size.first, arguments.size.second});
}

}  // namespace

void add_render_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("render", "Draw a character, rigged or not, into a PNG picture");
  auto arguments = std::make_shared<RenderArguments>();
  command->add_option("input", arguments->input, "The character: any format that `rig` reads")->required()->type_name("FILE");
  command->add_option("-o,--output", arguments->output, "The picture to write (PNG)")->required()->type_name("FILE");
  command->add_option("--pose", arguments->pose, "Show a rigged character in a random pose too: a number, or none")->capture_default_str();
  command->add_option("--size", arguments->size, "Width and height of the picture in pixels")
      ->delimiter(',')
      ->type_name("WIDTH,HEIGHT")
      ->check(CLI::Range(16, 16384))
      ->capture_default_str();
  add_load_options(*command, arguments->load);
  command->callback([arguments] { render(*arguments); });
}

}  // namespace osteon::app
