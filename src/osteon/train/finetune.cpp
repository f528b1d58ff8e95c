// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/finetune.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "osteon/base/error.h"
#include "osteon/base/progress.h"

namespace osteon::train {
namespace {

namespace fs = std::filesystem;
using dataset::Example;
using nets::rignet::name_of;
using nets::rignet::Network;

struct Recipe {
  Task task;
  Network network;
  double share;  // of the time, where all are there
  double learning_rate;
  std::size_t batch_size;
};
// Batches as for the shipped weights (docs/training.md), a fifth of their learning rates.
constexpr Recipe kRecipes[] = {{Task::votes, Network::votes, 0.5, 4e-4, 3},
                               {Task::bind, Network::bind, 0.25, 6e-4, 4},
                               {Task::neuroskinning, Network::neuroskinning, 0.15, 6e-4, 4},
                               {Task::tree, Network::tree, 0.1, 3e-4, 8}};

fs::path file_of(const fs::path& folder, Network network) { return folder / fmt::format("{}.safetensors", name_of(network)); }

// Those whose weights are there.
std::vector<Recipe> recipes_for(const fs::path& init) {
  std::vector<Recipe> present;
  std::ranges::copy_if(kRecipes, std::back_inserter(present), [&](const Recipe& r) { return fs::exists(file_of(init, r.network)); });
  const double sum = std::accumulate(present.begin(), present.end(), 0.0, [](double s, const Recipe& r) { return s + r.share; });
  for (Recipe& recipe : present) recipe.share /= sum;
  return present;
}

// What NeuroSkinning's weights read joints by, where they are among the recipes'.
std::shared_ptr<const skin::SuperSkeleton> super_skeleton_of(const std::vector<Recipe>& recipes, const fs::path& init) {
  const auto reads = std::ranges::find(recipes, Task::neuroskinning, &Recipe::task);
  return reads == recipes.end() ? nullptr : std::make_shared<const skin::SuperSkeleton>(load_super_skeleton(file_of(init, reads->network)));
}

std::vector<Example> examples_of(std::vector<dataset::PreparedCharacter> characters, Task task) {
  if (is_about_pairs(task)) std::erase_if(characters, [](const auto& c) { return c.joints() < 2; });
  return dataset::examples_of(std::move(characters), parts_of(task));
}

// Own characters first. Half of what is drawn is general, where there is any.
struct TrainingSet {
  std::vector<Example> examples;
  std::vector<double> sampling;
};
TrainingSet training_set(const FinetuneData& data, Task task) {
  TrainingSet set{examples_of(data.own, task), {}};
  std::vector<Example> general = examples_of(data.general, task);
  const double own_share = general.empty() ? 1.0 : 0.5;
  for (const double w : dataset::sampling_weights(set.examples)) set.sampling.push_back(own_share * w);
  for (const double w : dataset::sampling_weights(general)) set.sampling.push_back((1.0 - own_share) * w);
  std::ranges::move(general, std::back_inserter(set.examples));
  return set;
}

TrainOptions train_options(const Recipe& recipe, const FinetuneOptions& options, std::vector<double> sampling,
                           std::shared_ptr<const skin::SuperSkeleton> super_skeleton) {
  TrainOptions out;
  out.task.run = options.run;
  out.task.run.norm = {.momentum = 0.01, .largest_stretch = 10.0, .largest_offset = 10.0};
  out.task.attention_weight = 0.02;  // that of `osteon-train rignet.votes`
  if (recipe.task == Task::neuroskinning) out.task.batch.super_skeleton = std::move(super_skeleton);
  if (recipe.task == Task::votes) out.augment.fold = 0.0f;  // one's own rigs are wanted as they are (docs/training.md)
  out.batch_size = recipe.batch_size;
  out.learning_rate = recipe.learning_rate;
  out.steps = options.steps;
  out.minutes = recipe.share * options.minutes;
  out.seed = options.seed;
  out.report_seconds = options.report_seconds;
  out.validate_seconds = std::numeric_limits<double>::infinity();
  out.validations = 10;
  out.keep_best = out.trained_before = true;
  out.sampling = std::move(sampling);
  out.checkpoint = options.checkpoints / fmt::format("{}.checkpoint", name_of(recipe.network));
  return out;
}

Model model_of(Network network, const fs::path& file) {
  Model model;
  model[name_of(network)] = load_weights(file, network);
  return model;
}

std::map<std::string, double> figures_of(const Recipe& recipe, const fs::path& folder, const std::vector<Example>& validation,
                                         const TrainOptions& options) {
  Model model = model_of(recipe.network, file_of(folder, recipe.network));
  for (auto& [name, value] : model[name_of(recipe.network)]) value = value.to(options.task.run.device);
  TaskOptions task = options.task;
  task.batch.parts = parts_of(recipe.task);
  return validate(recipe.task, model, validation, task);
}

void copy_weights(Network network, const FinetuneOptions& options, std::map<std::string, std::string> metadata) {
  metadata["tuned"] = "no: nothing was better than the start";
  save_weights(file_of(options.output, network), load_weights(file_of(options.init, network), network), metadata);
}

std::map<std::string, std::string> metadata_of(const TrainOptions& training, const FinetuneOptions& options) {
  auto metadata = options.metadata;
  metadata["seed"] = std::to_string(options.seed);
  if (const auto& super = training.task.batch.super_skeleton) metadata["super_skeleton"] = super->to_json();
  return metadata;
}

// Trains and writes the file.
void tune(const Recipe& recipe, const TrainingSet& set, const std::vector<Example>& validation, const TrainOptions& training,
          const FinetuneOptions& options, const std::function<void(const TrainReport&)>& report, const std::function<bool()>& stop) {
  Trainer trainer(recipe.task, training, model_of(recipe.network, file_of(options.init, recipe.network)));
  if (fs::exists(training.checkpoint)) trainer.resume();
  const TrainResult result = trainer.run(set.examples, validation, report, stop);
  if (result.ending == Ending::stopped) throw Cancelled();
  auto metadata = metadata_of(training, options);
  metadata["steps"] = std::to_string(result.steps);
  metadata["seconds"] = fmt::format("{:.0f}", result.seconds);
  metadata["validation"] = nlohmann::json(result.validation).dump();
  save_weights(file_of(options.output, recipe.network), trainer.model()[name_of(recipe.network)], metadata);
  // Rounding to half precision may undo a tiny gain.
  const double before = figures_of(recipe, options.init, validation, training).at("loss");
  if (!(figures_of(recipe, options.output, validation, training).at("loss") < before)) copy_weights(recipe.network, options, metadata);
  fs::remove(training.checkpoint);
}

}  // namespace

std::vector<FinetunedNetwork> finetune(const FinetuneData& data, const FinetuneOptions& options,
                                       const std::function<void(const std::string& network, const TrainReport&)>& report,
                                       const std::function<bool()>& stop) {
  std::vector<FinetunedNetwork> results;
  const std::vector<Recipe> recipes = recipes_for(options.init);
  const auto super_skeleton = super_skeleton_of(recipes, options.init);
  for (const Recipe& recipe : recipes) {
    const std::string name = name_of(recipe.network);
    const std::vector<Example> validation = examples_of(data.validation, recipe.task);
    const TrainingSet set = training_set(data, recipe.task);
    const TrainOptions training = train_options(recipe, options, set.sampling, super_skeleton);
    const bool finished = fs::exists(file_of(options.output, recipe.network));
    if (set.examples.empty() || validation.empty()) {
      copy_weights(recipe.network, options, metadata_of(training, options));
      results.push_back({name, {}, {}});
      continue;
    }
    if (!finished)
      tune(
          recipe, set, validation, training, options, [&](const TrainReport& r) { report(name, r); }, stop);
    results.push_back(
        {name, figures_of(recipe, options.init, validation, training), figures_of(recipe, options.output, validation, training)});
  }
  return results;
}

}  // namespace osteon::train
