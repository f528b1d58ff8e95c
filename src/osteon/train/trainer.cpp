// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/trainer.h"

#include <ATen/core/grad_mode.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>
#include <utility>

#include "osteon/base/error.h"
#include "osteon/train/gemm.h"

namespace osteon::train {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string task_name(Task task) {
  switch (task) {
    case Task::attention:
      return "attention";
    case Task::joints:
      return "joints";
    case Task::collapse:
      return "collapse";
    case Task::votes:
      return "votes";
    case Task::bones:
      return "bones";
    case Task::root:
      return "root";
    case Task::tree:
      return "tree";
    case Task::skin:
      return "skin";
    case Task::bind:
      return "bind";
    case Task::neuroskinning:
      return "neuroskinning";
    case Task::neuroskinning_2019:
      return "neuroskinning_2019";
  }
  return "";
}

Model copy_of(const Model& model) {
  Model copy;
  for (const auto& [part, parameters] : model.parts)
    for (const auto& [name, value] : parameters) copy[part][name] = value.detach().clone();
  return copy;
}

void set(Model& model, const Model& values) {
  const at::NoGradGuard no_grad;
  for (auto& [part, parameters] : model.parts)
    for (auto& [name, value] : parameters) value.copy_(values.parts.at(part).at(name));
}

constexpr std::string_view best_prefix = "best/";

void add_arrays(Safetensors& file, const Model& model, std::string_view prefix) {
  for (const auto& [part, parameters] : model.parts)
    for (const auto& [name, value] : parameters) file.arrays[fmt::format("{}{}/{}", prefix, part, name)] = to_array(value);
}

// The arrays of the model's names.
Model model_of(const Safetensors& file, const Model& names, std::string_view prefix) {
  Model model;
  for (const auto& [part, parameters] : names.parts)
    for (const auto& [name, value] : parameters) model[part][name] = from_array(file.at(fmt::format("{}{}/{}", prefix, part, name)));
  return model;
}

// Means of what is added since the last take().
class Averages {
 public:
  void add(const std::map<std::string, double>& figures) {
    for (const auto& [name, value] : figures) sum_[name] += value;
    ++count_;
  }
  std::map<std::string, double> take() {
    for (auto& [name, value] : sum_) value /= count_;
    count_ = 0;
    return std::exchange(sum_, {});
  }

 private:
  std::map<std::string, double> sum_;
  int count_ = 0;
};

// Says yes once in `period` seconds, first after one period.
class Timer {
 public:
  explicit Timer(double period) : period_(period), last_(Clock::now()) {}
  bool due() {
    if (seconds_since(last_) < period_) return false;
    last_ = Clock::now();
    return true;
  }

 private:
  double period_;
  Clock::time_point last_;
};

}  // namespace

Trainer::Trainer(Task task, const TrainOptions& options, Model model)
    : task_(task), options_(options), model_(std::move(model)), adam_(options.adam) {
  options_.task.run.mode = Mode::training;
  options_.task.batch.parts = parts_of(task);
  if (options_.echo == 0 || options_.batch_size % options_.echo != 0)
    throw Error("echo: found {}, expected a divisor of the {} characters of a step", options_.echo, options_.batch_size);
  if (options_.steps <= 0 && options_.minutes <= 0.0) throw Error("training needs an end: a number of steps or of minutes");
  for (auto& [part, parameters] : model_.parts) prepare_for_training(parameters, options_.task.run.device);
}

double Trainer::progress() const {
  double done = 0.0;
  if (options_.steps > 0) done = static_cast<double>(step_) / static_cast<double>(options_.steps);
  if (options_.minutes > 0.0) done = std::max(done, seconds_ / (60.0 * options_.minutes));
  return std::min(done, 1.0);
}

double Trainer::learning_rate() const {
  const double t = progress();
  if (t < options_.warm_up) return options_.learning_rate * std::max(t / options_.warm_up, 0.02);
  return options_.learning_rate * 0.5 * (1.0 + std::cos(std::numbers::pi * (t - options_.warm_up) / (1.0 - options_.warm_up)));
}

Variations Trainer::variations_of(const std::vector<dataset::Example>& train) const {
  std::vector<double> weights = options_.sampling.empty() ? dataset::sampling_weights(train) : options_.sampling;
  const auto share = [this, &train, weights = std::move(weights)](std::uint64_t stream) {
    Random random = Random(options_.seed).fork(stream);
    Variations::Characters changed;
    for (const std::size_t i : dataset::draw(weights, options_.batch_size / options_.echo, random))
      changed.push_back(dataset::varied(train[i], options_.task.batch.parts, options_.augment, random));
    return changed;
  };
  return Variations(share, options_.echo);
}

dataset::Batch Trainer::batch_of(Variations& variations, std::uint64_t number) const {
  Random random = Random(options_.seed).fork(number).fork(1);  // not what they were changed by
  const Variations::Characters characters = variations.of(number);
  std::vector<const dataset::Example*> shown;
  for (const auto& character : characters) shown.push_back(character.get());
  return dataset::training_batch(shown, options_.task.batch, options_.augment, random);
}

// Plain batch normalisation at first, while the running figures still chase the weights; then more and more renormalised. The running
// figures begin as plain means.
NormRule Trainer::norm_rule() const {
  const NormRule& full = options_.task.run.norm;
  constexpr double from = 100.0, to = 600.0;  // steps: after these the running figures of momentum 0.01 are averages worth correcting to
  const double begun = (static_cast<double>(step_) - from) / (to - from);
  const double t = std::clamp(begun, 0.0, 1.0);
  if (options_.trained_before) return full;
  return {std::max(full.momentum, 1.0 / static_cast<double>(step_ + 1)), 1.0 + t * (full.largest_stretch - 1.0), t * full.largest_offset};
}

std::map<std::string, double> Trainer::step(BatchesAhead& batches) {
  const Stopwatch whole;
  const GemmTotals before = gemm_totals();
  const dataset::Batch batch = batches.next();
  profile_.waiting += whole.seconds();
  const Stopwatch forward;
  TaskOptions task = options_.task;
  task.run.norm = norm_rule();
  const at::Tensor loss = training_loss(task_, model_, batch, task);
  profile_.forward += forward.seconds();
  const Stopwatch backward;
  loss.backward();
  profile_.backward += backward.seconds();
  const Stopwatch optimiser;
  const double rate = learning_rate();
  const double norm = adam_.step(model_, rate);
  profile_.optimiser += optimiser.seconds();
  const GemmTotals after = gemm_totals();
  profile_.products += after.seconds - before.seconds;
  profile_.multiplications += after.multiplications - before.multiplications;
  ++profile_.steps;
  ++step_;
  const double seconds = whole.seconds();
  seconds_ += seconds;
  std::map<std::string, double> figures{
      {"loss", loss.item<double>()}, {"gradient_norm", norm}, {"learning_rate", rate}, {"seconds_per_step", seconds}};
  if (model_.parts.contains("bandwidth")) figures["bandwidth"] = model_["bandwidth"].at("h").item<double>();
  return figures;
}

void Trainer::keep_if_best(const std::map<std::string, double>& figures) {
  if (!options_.keep_best || (best_ && !(figures.at("loss") < best_->figures.at("loss")))) return;
  best_ = Best{figures, copy_of(model_)};
}

TrainResult Trainer::run(const std::vector<dataset::Example>& train, const std::vector<dataset::Example>& validation,
                         const std::function<void(const TrainReport&)>& report, const std::function<bool()>& stop) {
  const auto validated = [&] {
    auto figures = validate(task_, model_, validation, options_.task);
    keep_if_best(figures);
    report({step_, seconds_, progress(), true, figures});
    return figures;
  };
  const auto looks_due = [&] { return static_cast<int>(progress() * options_.validations); };
  if (options_.keep_best && !best_) validated();
  Averages averages;
  Timer report_timer(options_.report_seconds), validation_timer(options_.validate_seconds), checkpoint_timer(options_.checkpoint_seconds);
  Variations variations = variations_of(train);
  BatchesAhead batches([&](std::uint64_t number) { return batch_of(variations, number); }, static_cast<std::uint64_t>(step_));
  bool stopped = false;
  while (progress() < 1.0 && !(stopped = stop())) {
    const int looks = looks_due();
    averages.add(step(batches));
    if (report_timer.due() || progress() >= 1.0) report({step_, seconds_, progress(), false, averages.take()});
    if (progress() < 1.0 && (looks_due() > looks || validation_timer.due())) validated();
    if (checkpoint_timer.due()) save();
  }
  profile_.making += batches.seconds_of_making();
  TrainResult result{stopped ? Ending::stopped : Ending::complete, step_, seconds_, {}};
  if (!stopped) {
    result.validation = validated();
    if (best_) {
      set(model_, best_->model);
      result.validation = best_->figures;
    }
  }
  save();
  return result;
}

void Trainer::save() const {
  if (options_.checkpoint.empty()) return;
  Safetensors file;
  file.metadata = {{"task", task_name(task_)}, {"step", std::to_string(step_)}, {"seconds", fmt::format("{}", seconds_)}};
  add_arrays(file, model_, "");
  if (best_) {
    file.metadata["best"] = nlohmann::json(best_->figures).dump();
    add_arrays(file, best_->model, best_prefix);
  }
  adam_.save(file);
  save_safetensors(options_.checkpoint, file);
}

void Trainer::resume() {
  const Safetensors file = load_safetensors(options_.checkpoint);
  const auto task = file.metadata.find("task");
  if (task == file.metadata.end() || task->second != task_name(task_))
    throw Error("{}: task: found {}, expected {}", options_.checkpoint.string(), task == file.metadata.end() ? "none" : task->second,
                task_name(task_));
  try {
    step_ = std::stoll(file.metadata.at("step"));
    seconds_ = std::stod(file.metadata.at("seconds"));
    set(model_, model_of(file, model_, ""));
    if (const auto best = file.metadata.find("best"); options_.keep_best && best != file.metadata.end())
      best_ = Best{nlohmann::json::parse(best->second).get<std::map<std::string, double>>(), model_of(file, model_, best_prefix)};
    adam_.load(file, options_.task.run.device);
  } catch (const std::exception& e) {
    throw Error("{}: not a checkpoint of this network: {}", options_.checkpoint.string(), e.what());
  }
}

}  // namespace osteon::train
