// SPDX-License-Identifier: Apache-2.0
#include "finetune_command.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "../interrupt.h"
#include "../numbers.h"
#include "../outputs.h"
#include "../progress_bar.h"
#include "characters.h"
#include "device.h"
#include "osteon/base/parallel.h"
#include "osteon/base/progress.h"
#include "osteon/dataset/holdout.h"
#include "osteon/dataset/pack.h"
#include "osteon/infer/model_folder.h"
#include "osteon/train/finetune.h"
#include "osteon_commit.h"
#include "training_log.h"

namespace osteon::app {
namespace {

namespace fs = std::filesystem;

struct FinetuneArguments {
  fs::path data, output, init, log;
  std::vector<fs::path> general;
  std::string device = "cpu";
  int threads = 0;
  double validation_share = 0.15;
  bool resume = false;
  train::FinetuneOptions options;

  FinetuneArguments() { options.minutes = 30.0; }
};

// What a run that is not finished keeps in the output folder.
struct Unfinished {
  fs::path folder;
  fs::path train() const { return folder / "train.safetensors"; }
  fs::path validation() const { return folder / "val.safetensors"; }
};

// Nothing but what a run leaves that was stopped while it prepared the characters.
bool is_free(const fs::path& folder, const Unfinished& unfinished) {
  if (!fs::exists(folder)) return true;
  return fs::is_directory(folder) && std::ranges::all_of(fs::recursive_directory_iterator(folder), [&](const fs::directory_entry& entry) {
           const fs::path& path = entry.path();
           return path == unfinished.folder || path == unfinished.validation() || path.extension() == ".tmp";
         });
}

void check_output(const FinetuneArguments& a, const Unfinished& unfinished) {
  const bool begun = fs::exists(unfinished.train());
  if (a.resume && !begun) throw Error("{}: found no unfinished run to go on with", a.output.string());
  if (!a.resume && begun) throw Error("{}: holds an unfinished run: go on with it with --resume, or remove it", a.output.string());
  if (!a.resume && !is_free(a.output, unfinished)) throw Error("{}: is not empty; expected a new folder", a.output.string());
  if (!a.log.empty()) check_outputs(a.general, {{"--log", a.log, ""}});
}

// What the result follows from: a run is gone on with by the same.
std::string recipe_of(const FinetuneArguments& a) {
  std::string text =
      fmt::format("{} --init-models {}", fs::weakly_canonical(a.data).string(), fs::weakly_canonical(a.options.init).string());
  for (const fs::path& file : a.general) text += " --with " + fs::weakly_canonical(file).string();
  return text + (a.options.steps > 0 ? fmt::format(" --steps {}", a.options.steps) : fmt::format(" --minutes {}", a.options.minutes)) +
         fmt::format(" --val-share {} --seed {}", a.validation_share, a.options.seed);
}

void check_recipe(const FinetuneArguments& a, const Unfinished& unfinished) {
  const auto metadata = load_safetensors(unfinished.train()).metadata;
  const auto begun = metadata.find("recipe");
  if (begun != metadata.end() && begun->second != recipe_of(a))
    throw Error("{}: was begun with {}; found {}, expected the same", a.output.string(), begun->second, recipe_of(a));
}

// Before the long work begins.
void check_weights(const fs::path& folder) {
  for (const char* name : {"votes", "bind", "tree"})
    if (const fs::path file = folder / fmt::format("{}.safetensors", name); !fs::exists(file))
      throw Error("{}: not there; expected the weights to start from", file.string());
}

// Reads, splits and keeps the user's characters.
void prepare(const FinetuneArguments& a, const Unfinished& unfinished, ProgressBar& bar) {
  Characters characters = read_characters(a.data, [&](double share) { bar.show("preparing", share); });
  for (const std::string& why : characters.left_out) std::fprintf(stderr, "warning: left out: %s\n", why.c_str());
  if (characters.validation.empty()) {
    auto all = std::move(characters.train);
    const dataset::Holdout split = dataset::hold_out(all, a.validation_share, a.options.seed);
    characters.train.clear();
    for (const std::size_t i : split.train) characters.train.push_back(std::move(all[i]));
    for (const std::size_t i : split.validation) characters.validation.push_back(std::move(all[i]));
  }
  if (characters.train.empty()) throw Error("{}: its manifest has characters of split val alone, expected some of train", a.data.string());
  fs::create_directories(unfinished.folder);
  dataset::save_characters(unfinished.validation(), characters.validation, {{"sources", characters.sources}});
  dataset::save_characters(unfinished.train(), characters.train, {{"sources", characters.sources}, {"recipe", recipe_of(a)}});
}

// The JSON list of a file's "sources" is put to the end of the list.
void add_sources(nlohmann::json& list, const fs::path& file) {
  const auto metadata = load_safetensors(file).metadata;
  const auto found = metadata.find("sources");
  if (found == metadata.end()) return;
  for (auto& source : nlohmann::json::parse(found->second))
    if (std::ranges::find(list, source) == list.end()) list.push_back(std::move(source));
}

// What the tuned weights say about themselves: all that they have learned from, the shipped weights' sources included.
std::map<std::string, std::string> metadata_of(const CLI::App& command, const FinetuneArguments& a, const Unfinished& unfinished) {
  nlohmann::json sources = nlohmann::json::array();
  add_sources(sources, a.options.init / "votes.safetensors");
  for (const fs::path& file : a.general) add_sources(sources, file);
  add_sources(sources, unfinished.train());
  return {{"sources", sources.dump()},
          {"recipe", command.get_name() + ' ' + command.config_to_str(false, false)},
          {"commit", OSTEON_COMMIT},
          {"tuned", "from " + a.options.init.string()}};
}

std::string remark(const train::TrainReport& report, std::map<std::string, double>& losses) {
  losses[report.is_validation ? "validation loss" : "loss"] = report.figures.at("loss");
  std::string text;
  for (const auto& [name, value] : losses) text += fmt::format("{} {:.4g}  ", name, value);
  return text;
}

void print_table(const std::vector<train::FinetunedNetwork>& networks) {
  std::printf("%-14s %-12s %10s %10s\n", "network", "validation", "before", "after");
  for (const auto& network : networks) {
    if (network.before.empty()) std::printf("%-14s copied\n", network.name.c_str());
    for (const auto& [figure, value] : network.before)
      std::printf("%-14s %-12s %10.4f %10.4f\n", network.name.c_str(), figure.c_str(), value, network.after.at(figure));
  }
}

std::vector<dataset::PreparedCharacter> load_general(const FinetuneArguments& a) {
  std::vector<dataset::PreparedCharacter> general;
  for (const fs::path& file : a.general) std::ranges::move(dataset::load_characters(file), std::back_inserter(general));
  return general;
}

void finetune(const CLI::App& command, FinetuneArguments a) {
  if (a.threads > 0) {
    at::set_num_threads(a.threads);
    set_threads(a.threads);
  }
  const Unfinished unfinished{a.output / "unfinished"};
  check_output(a, unfinished);
  a.options.init = a.init.empty() ? infer::find_models("rignet") : a.init;
  check_weights(a.options.init);
  a.options.output = a.output;
  a.options.checkpoints = unfinished.folder;
  choose_device(a.device, a.options.run);
  if (a.options.steps > 0) a.options.minutes = 0.0;

  std::vector<train::FinetunedNetwork> networks;
  {
    ProgressBar bar;
    if (a.resume) check_recipe(a, unfinished);
    train::FinetuneData data{{}, {}, load_general(a)};  // and the log: what is wrong with them is said first
    TrainingLog log(a.log, TrainingLog::Shown::in_file_alone);
    if (!a.resume) prepare(a, unfinished, bar);
    a.options.metadata = metadata_of(command, a, unfinished);
    data.own = dataset::load_characters(unfinished.train());
    data.validation = dataset::load_characters(unfinished.validation());
    std::map<std::string, std::map<std::string, double>> losses;
    catch_interrupts();
    try {
      networks = train::finetune(
          data, a.options,
          [&](const std::string& network, const train::TrainReport& report) {
            log(report);
            bar.show(network, report.progress, remark(report, losses[network]));
          },
          [] { return interrupted != 0; });
    } catch (const Cancelled&) {
      std::fprintf(stderr, "\nstopped; the same command with --resume goes on\n");
      throw;
    }
  }
  fs::remove_all(unfinished.folder);
  print_table(networks);
}

}  // namespace

void add_finetune_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("finetune", "Make the shipped networks fit a folder of your own rigged characters");
  auto a = std::make_shared<FinetuneArguments>();
  command->add_option("folder", a->data, "Folder with rigged GLB files, also in folders below; manifest.jsonl is heeded where there is one")
      ->required();
  command->add_option("-o,--output", a->output, "The new folder of weights, for `osteon rig --models`")->required();
  command->add_option("--init-models", a->init, "Weights to start from (default: the shipped ones)")->check(CLI::ExistingDirectory);
  command->add_option("--with", a->general, "General characters (of `osteon dataset prepare`) to mix in by half, against forgetting")
      ->check(CLI::ExistingFile);
  auto* minutes =
      command->add_option("--minutes", a->options.minutes, "Time for all networks together")->check(above_zero())->capture_default_str();
  command->add_option("--steps", a->options.steps, "Steps of each network, in place of the time")->check(above_zero())->excludes(minutes);
  command->add_option("--val-share", a->validation_share, "Share of the characters that is kept for validation")
      ->check(within(0.01, 0.9))
      ->capture_default_str();
  command->add_option("--seed", a->options.seed)->check(not_negative())->capture_default_str();
  command->add_option("--device", a->device, "cpu, cuda or cuda:N")->capture_default_str();
  command->add_option("--threads", a->threads, "CPU threads (default: all cores)")->check(CLI::Range(1, 1024));
  command->add_flag("--resume", a->resume, "Go on after Ctrl-C, with the same other options");
  command->add_option("--log", a->log, "Figures as JSON lines, appended");
  command->callback([command, a] { finetune(*command, *a); });
}

}  // namespace osteon::app
