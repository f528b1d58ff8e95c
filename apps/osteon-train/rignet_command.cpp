// SPDX-License-Identifier: Apache-2.0
#include "rignet_command.h"

#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "../interrupt.h"
#include "../numbers.h"
#include "../outputs.h"
#include "device.h"
#include "osteon/base/parallel.h"
#include "osteon/base/progress.h"
#include "osteon/base/random.h"
#include "osteon/dataset/pack.h"
#include "osteon/train/trainer.h"
#include "osteon_commit.h"
#include "training_log.h"

namespace osteon::app {
namespace {

using nets::rignet::name_of;
using nets::rignet::Network;
using train::Task;
namespace fs = std::filesystem;

struct Arguments {
  std::vector<fs::path> data;
  std::vector<double> shares;
  double groups = 1.0;
  fs::path validation, out, init, attention, attention_out, log;
  std::string device = "cpu";
  int threads = 0;
  bool resume = false, combined = false, no_augmentation = false, no_placement = false, profile = false;
  double bandwidth = 0.04;
  train::TrainOptions options;

  Arguments() { options.task.run.norm = {.momentum = 0.01, .largest_stretch = 10.0, .largest_offset = 10.0}; }
};

void add_common_options(CLI::App& command, Arguments& a) {
  command.add_option("--data", a.data, "Training characters (safetensors of `osteon dataset prepare`; several files are put together)")
      ->required()
      ->check(CLI::ExistingFile);
  command.add_option("--shares", a.shares, "How much of what is shown is of each file of --data (default: all files drawn from as one)")
      ->check(not_negative());
  command.add_option("--groups", a.groups, "Learn from this share of each file's groups alone, to see what more data brings")
      ->check(within(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--val", a.validation, "Validation characters")->check(CLI::ExistingFile);
  command.add_option("--out", a.out, "Where the weights go (safetensors)")->required();
  command.add_option("--init", a.init, "Weights to start from")->check(CLI::ExistingFile);
  command.add_option("--minutes", a.options.minutes, "Train for this long")->check(not_negative());
  command.add_option("--steps", a.options.steps, "Train for this many steps")->check(not_negative());
  command.add_option("--batch", a.options.batch_size, "Characters a step")->check(above_zero())->capture_default_str();
  command
      .add_option("--echo", a.options.echo,
                  "In how many steps each changed character is shown, placed anew; for where steps wait for batches (divides --batch)")
      ->check(above_zero())
      ->capture_default_str();
  command.add_option("--lr", a.options.learning_rate, "Largest learning rate")->check(above_zero())->capture_default_str();
  command.add_option("--weight-decay", a.options.adam.weight_decay, "Decoupled weight decay")->check(not_negative())->capture_default_str();
  command.add_option("--clip", a.options.adam.largest_norm, "Largest norm of the gradient (0: any)")
      ->check(not_negative())
      ->capture_default_str();
  command.add_option("--warm-up", a.options.warm_up, "Share of the run in which the learning rate rises")
      ->check(within(0.0, 0.9))
      ->capture_default_str();
  command.add_option("--momentum", a.options.task.run.norm.momentum, "Of the normalisations' running figures")
      ->check(within(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--largest-stretch", a.options.task.run.norm.largest_stretch, "Of batch renormalisation (1: plain batches)")
      ->check(within(1.0, 100.0))
      ->capture_default_str();
  command.add_option("--largest-offset", a.options.task.run.norm.largest_offset, "Of batch renormalisation (0: plain batches)")
      ->check(not_negative())
      ->capture_default_str();
  command.add_option("--neighbours", a.options.task.batch.neighbours, "Geodesic neighbours of a vertex")
      ->check(not_negative())
      ->capture_default_str();
  command.add_flag("--no-augmentation", a.no_augmentation, "Show every character as it is");
  command.add_flag("--no-placement", a.no_placement, "Neither mirror, turn nor stretch the whole character");
  auto& articulate = a.options.augment.articulate;
  command.add_option("--articulate", articulate.probability, "How often a character is bent and scaled through its rig")
      ->check(within(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--bend", articulate.largest_bend, "Largest standard deviation of joint angles, radians")
      ->check(not_negative())
      ->capture_default_str();
  command.add_option("--reduce", a.options.augment.reduce, "How often a mesh is reduced (not for skin and bind)")
      ->check(within(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--fold", a.options.augment.fold, "How often a character gets a coarser rig")
      ->check(within(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--proportion", articulate.proportion, "Standard deviation of the logarithm of a part's size")
      ->check(not_negative())
      ->capture_default_str();
  command
      .add_option("--from-motion", articulate.from_motion,
                  "Share of those bent that stand in one of their poses of `dataset prepare --motions`")
      ->check(within(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--drop", a.options.augment.drop, "How often a character loses some of its accessories")
      ->check(within(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--flip", a.options.augment.flip, "How often edges of the mesh are flipped")
      ->check(within(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--seed", a.options.seed)->check(not_negative())->capture_default_str();
  command.add_option("--device", a.device, "cpu, cuda or cuda:N")->capture_default_str();
  command.add_option("--threads", a.threads, "CPU threads (default: all cores)")->check(CLI::Range(1, 1024));
  auto* checkpoint = command.add_option("--checkpoint", a.options.checkpoint, "Written every two minutes, at the end and on Ctrl-C");
  command.add_flag("--resume", a.resume, "Go on from the checkpoint")->needs(checkpoint);
  command.add_option("--log", a.log, "Figures as JSON lines, appended");
  command.add_flag("--profile", a.profile, "Say at the end where the time went");
  command.add_option("--report-seconds", a.options.report_seconds)->check(not_negative())->capture_default_str();
  command.add_option("--validate-seconds", a.options.validate_seconds)->check(not_negative())->capture_default_str();
}

void add_votes_options(CLI::App& command, Arguments& a) {
  a.options.task.attention_weight = 0.02;
  command.add_option("--density-weight", a.options.task.density_weight, "Of the votes' density at the joints")
      ->check(not_negative())
      ->capture_default_str();
  command.add_option("--attention-weight", a.options.task.attention_weight, "Of the attention's own loss")
      ->check(not_negative())
      ->capture_default_str();
}

void add_bones_options(CLI::App& command, Arguments& a) {
  command.add_flag("--hide-mesh", a.options.task.batch.hide_mesh, "Studies: the network does not see the shape")->group("Studies");
  command.add_flag("--hide-joints", a.options.task.batch.hide_joints, "Studies: nor the other joints of the skeleton")->group("Studies");
}

void add_neuroskinning_options(CLI::App& command, Arguments& a) {
  command.add_option("--difference-weight", a.options.task.difference_weight, "Of the weights' L1 distance, against their cross-entropy")
      ->check(not_negative())
      ->capture_default_str();
  command.add_option("--nameless", a.options.augment.nameless, "How often the joints' names are not read")
      ->check(within(0.0, 1.0))
      ->capture_default_str();
}

void add_combined_options(CLI::App& command, Arguments& a) {
  auto* combined =
      command.add_flag("--combined", a.combined, "Train displacement, attention and bandwidth together, through the mean shift");
  command.add_option("--attention", a.attention, "Attention weights to start from")->check(CLI::ExistingFile)->needs(combined);
  command.add_option("--attention-out", a.attention_out, "Where the attention's weights go")->needs(combined);
  command.add_option("--bandwidth", a.bandwidth, "Bandwidth to start from")->check(above_zero())->needs(combined)->capture_default_str();
  command.add_option("--vertex-weight", a.options.task.vertex_weight, "Of the displaced vertices' loss where all is trained together")
      ->needs(combined)
      ->check(not_negative())
      ->capture_default_str();
  command.add_option("--collapse-weight", a.options.task.collapse_weight, "Of the collapsed points' loss")
      ->check(not_negative())
      ->capture_default_str();
  command.add_option("--attention-weight", a.options.task.attention_weight, "Of the attention's own loss")
      ->check(not_negative())
      ->capture_default_str();
}

// Only characters of a share of the groups, drawn by the seed; at least one. A character without a group is one by itself.
void keep_groups(std::vector<dataset::PreparedCharacter>& characters, double share, std::uint64_t seed) {
  const auto group_of = [](const dataset::PreparedCharacter& c) { return c.info.group.empty() ? c.info.id : c.info.group; };
  std::set<std::string> all;
  for (const auto& c : characters) all.insert(group_of(c));
  std::vector<std::string> drawn(all.begin(), all.end());
  Random(seed).shuffle<std::string>(drawn);
  const auto kept = static_cast<std::size_t>(std::ceil(share * static_cast<double>(drawn.size())));
  const std::set<std::string> left_out(drawn.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(kept, 1)), drawn.end());
  std::erase_if(characters, [&](const auto& c) { return left_out.contains(group_of(c)); });
}

std::vector<dataset::Example> examples_of(const fs::path& file, Task task, double groups = 1.0, std::uint64_t seed = 0) {
  std::vector<dataset::PreparedCharacter> characters = dataset::load_characters(file);
  if (groups < 1.0) keep_groups(characters, groups, seed);
  if (train::is_about_pairs(task)) std::erase_if(characters, [](const auto& c) { return c.joints() < 2; });
  if (characters.empty()) throw Error("{}: no characters to learn from", file.string());
  return dataset::examples_of(std::move(characters), train::parts_of(task));
}

// All files' characters, and how often to draw each; no weights where no shares are given.
struct Corpus {
  std::vector<dataset::Example> examples;
  std::vector<double> sampling;
};

Corpus corpus_of(const Arguments& a, Task task) {
  if (!a.shares.empty() && a.shares.size() != a.data.size())
    throw Error("--shares: found {} numbers for {} files of --data, expected one for each", a.shares.size(), a.data.size());
  const auto counts = [](double share) { return share > 0.0 && std::isfinite(share); };
  if (!a.shares.empty() && std::ranges::none_of(a.shares, counts)) throw Error("--shares: found no number above 0, expected one at least");
  Corpus corpus;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    std::vector<dataset::Example> of_file = examples_of(a.data[i], task, a.groups, a.options.seed);
    if (!a.shares.empty())
      for (const double weight : dataset::sampling_weights(of_file)) corpus.sampling.push_back(a.shares[i] * weight);
    std::ranges::move(of_file, std::back_inserter(corpus.examples));
  }
  return corpus;
}

bool reads_super_skeleton(Task task) { return task == Task::neuroskinning || task == Task::neuroskinning_2019; }

// That of the weights to start from, or a new one of all training characters.
skin::SuperSkeleton super_skeleton_of(const Corpus& corpus, const fs::path& init) {
  if (!init.empty()) return train::load_super_skeleton(init);
  std::vector<skin::NamedSkeleton> skeletons;
  for (const dataset::Example& e : corpus.examples) skeletons.push_back({&e.character.skeleton, e.character.info.group});
  return skin::learn_super_skeleton(skeletons, {.slots = nets::neuro_slots, .kinds = nets::neuro_kinds});
}

train::Model starting_model(Task task, const Arguments& a) {
  train::Model model = train::fresh_model(task, a.options.seed);
  for (const Network network : nets::rignet::kNetworks) {
    const bool second = task == Task::collapse && network == Network::attention;
    const fs::path& file = second ? a.attention : a.init;
    if (model.parts.contains(name_of(network)) && !file.empty()) model[name_of(network)] = train::load_weights(file, network);
  }
  if (model.parts.contains("bandwidth")) model["bandwidth"].at("h").fill_(a.bandwidth);
  return model;
}

// What the weights say about themselves.
std::map<std::string, std::string> metadata_of(const CLI::App& command, const Arguments& a, const train::TrainResult& result) {
  std::map<std::string, std::string> metadata;
  nlohmann::json sources = nlohmann::json::array();
  for (const fs::path& file : a.data) {
    const auto about = load_safetensors(file).metadata;
    if (const auto listed = about.find("sources"); listed != about.end())
      for (auto& source : nlohmann::json::parse(listed->second)) sources.push_back(std::move(source));
  }
  metadata["sources"] = sources.dump();
  metadata["recipe"] = command.get_name() + ' ' + command.config_to_str(false, false);
  metadata["commit"] = OSTEON_COMMIT;
  metadata["seed"] = std::to_string(a.options.seed);
  metadata["steps"] = std::to_string(result.steps);
  metadata["seconds"] = fmt::format("{:.0f}", result.seconds);
  metadata["validation"] = nlohmann::json(result.validation).dump();
  return metadata;
}

void save_weights(const CLI::App& command, const Arguments& a, Task task, train::Model& model, const train::TrainResult& result) {
  auto metadata = metadata_of(command, a, result);
  if (const auto& super = a.options.task.batch.super_skeleton) metadata["super_skeleton"] = super->to_json();
  if (model.parts.contains("bandwidth")) metadata["bandwidth"] = fmt::format("{}", model["bandwidth"].at("h").item<float>());
  for (const Network network : nets::rignet::kNetworks) {
    const std::string name = name_of(network);
    if (!model.parts.contains(name)) continue;
    const fs::path& file = task == Task::collapse && network == Network::attention ? a.attention_out : a.out;
    if (!file.empty()) train::save_weights(file, model[name], metadata);
  }
}

void check(const Arguments& a) {
  std::vector<fs::path> inputs = a.data;
  for (const fs::path* file : {&a.validation, &a.init, &a.attention})
    if (!file->empty()) inputs.push_back(*file);
  std::vector<Output> outputs{{"--out", a.out, ".safetensors"}};
  if (!a.attention_out.empty()) outputs.push_back({"--attention-out", a.attention_out, ".safetensors"});
  if (!a.options.checkpoint.empty()) outputs.push_back({"--checkpoint", a.options.checkpoint, ""});
  if (!a.log.empty()) outputs.push_back({"--log", a.log, ""});
  check_late_outputs(inputs, outputs);
  if (!a.resume && !a.options.checkpoint.empty() && fs::exists(a.options.checkpoint))
    throw Error("--checkpoint {}: is there already: go on from it with --resume, or remove it", a.options.checkpoint.string());
}

void run(const CLI::App& command, Task task, Arguments a) {
  check(a);
  if (a.threads > 0) {
    at::set_num_threads(a.threads);
    set_threads(a.threads);
  }
  if (a.combined) task = Task::collapse;
  if (a.no_augmentation) a.options.augment = dataset::AugmentOptions::none();
  if (a.no_placement) a.options.augment.place_nothing();
  choose_device(a.device, a.options.task.run);
  const Corpus corpus = corpus_of(a, task);
  a.options.sampling = corpus.sampling;
  a.options.trained_before = !a.init.empty();
  if (reads_super_skeleton(task))
    a.options.task.batch.super_skeleton = std::make_shared<const skin::SuperSkeleton>(super_skeleton_of(corpus, a.init));
  const auto validation = a.validation.empty() ? std::vector<dataset::Example>{} : examples_of(a.validation, task);
  train::Trainer trainer(task, a.options, starting_model(task, a));
  if (a.resume) trainer.resume();
  std::fprintf(stderr, "%s: %zu characters, %zu for validation, %llu parameters\n", command.get_name().c_str(), corpus.examples.size(),
               validation.size(), static_cast<unsigned long long>(train::count_of_trained(trainer.model())));
  TrainingLog log(a.log);
  catch_interrupts();
  const train::TrainResult result = trainer.run(corpus.examples, validation, std::ref(log), [] { return interrupted != 0; });
  if (result.steps > 0) save_weights(command, a, task, trainer.model(), result);
  if (a.profile) print_profile(trainer.profile());
  if (result.ending == train::Ending::complete) return;
  std::fprintf(stderr, "\nstopped after %lld steps%s\n", static_cast<long long>(result.steps),
               a.options.checkpoint.empty() ? "" : "; the same command with --resume goes on");
  throw Cancelled();
}

void add_command(CLI::App& app, Task task, const char* name, const char* description) {
  auto* command = app.add_subcommand(name, description);
  auto arguments = std::make_shared<Arguments>();
  if (task == Task::neuroskinning_2019) {
    arguments->options.augment.mirror = arguments->options.augment.half_turn = 0.0f;  // slots have sides
    arguments->options.task.run.norm = {.momentum = 0.05};  // renormalised to running figures it learns to rely on their lag
  }
  add_common_options(*command, *arguments);
  if (task == Task::joints) add_combined_options(*command, *arguments);
  if (task == Task::votes) add_votes_options(*command, *arguments);
  if (task == Task::bones) add_bones_options(*command, *arguments);
  if (reads_super_skeleton(task)) add_neuroskinning_options(*command, *arguments);
  command->callback([command, task, arguments] { run(*command, task, *arguments); });
}

}  // namespace

void add_rignet_commands(CLI::App& app) {
  add_command(app, Task::votes, "rignet.votes",
              "How far each vertex is from a joint and how well it can tell, in one network (the default)");
  add_command(app, Task::attention, "rignet.attention", "Where on the surface the joints are");
  add_command(app, Task::joints, "rignet.joints", "How far each vertex is from a joint; --combined: the whole joint stage");
  add_command(app, Task::tree, "rignet.tree", "Which joint is the parent of which (the default)");
  add_command(app, Task::bones, "rignet.bones", "Which joints a bone connects, by the paper's network");
  add_command(app, Task::root, "rignet.root", "Which joint is the root, by the paper's network");
  add_command(app, Task::bind, "rignet.bind", "How vertices follow the bones near them (the default)");
  add_command(app, Task::skin, "rignet.skin", "The same by the paper's network");
  add_command(app, Task::neuroskinning, "neuroskinning", "The same by graph attention, names and geodesic voxel binding");
  add_command(app, Task::neuroskinning_2019, "neuroskinning.2019", "The same by the network of NeuroSkinning's paper");
}

}  // namespace osteon::app
