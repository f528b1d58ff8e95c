// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "osteon/train/adam.h"
#include "osteon/train/batches_ahead.h"
#include "osteon/train/step_profile.h"
#include "osteon/train/tasks.h"
#include "osteon/train/variations.h"

namespace osteon::train {

struct TrainOptions {
  TaskOptions task;
  AdamOptions adam;
  dataset::AugmentOptions augment;
  std::size_t batch_size = 2;   // characters a step
  std::size_t echo = 1;         // in how many steps each changed character is shown, placed anew (variations.h); divides batch_size
  double learning_rate = 1e-3;  // the largest: it rises over the warm-up and then falls to zero along a cosine
  double warm_up = 0.03;        // share of the run
  std::int64_t steps = 0;       // the run ends after these ...
  double minutes = 0.0;         // ... or after this time, whichever is given (0: not)
  std::uint64_t seed = 1;
  double report_seconds = 15.0;
  double validate_seconds = 300.0;  // how often to look at the validation characters; at the end always
  int validations = 0;              // more such looks, spread evenly over the run
  bool keep_best = false;           // ends with the weights of the look with the smallest loss; the start is one too
  bool trained_before = false;      // the running figures of the normalisations are trusted from the first step on
  std::vector<double> sampling;     // how often to draw each character, sum 1; empty: dataset::sampling_weights
  double checkpoint_seconds = 120.0;
  std::filesystem::path checkpoint;  // empty: none are written
};

// What happened since the last report: mean figures of training, or figures of a validation.
struct TrainReport {
  std::int64_t step;
  double seconds;   // of training, over all resumed runs
  double progress;  // 0..1
  bool is_validation;
  std::map<std::string, double> figures;  // training: loss, gradient_norm, learning_rate, seconds_per_step
};

enum class Ending { complete, stopped };

struct TrainResult {
  Ending ending;
  std::int64_t steps;
  double seconds;
  std::map<std::string, double> validation;  // of the weights that it ends with; empty where it was stopped
};

// The state of a run. A batch depends on the seed and the number of the step alone, so a run that is stopped and resumed goes on exactly
// as if it had not been stopped (where the schedule goes by steps; by minutes it depends on the speed).
class Trainer {
 public:
  Trainer(Task task, const TrainOptions& options, Model model);

  // Continues from options.checkpoint. Throws Error when it is of another task or no checkpoint.
  void resume();

  // Trains until the end, or until `stop` says so; writes a checkpoint then. Pre: `train` is not empty.
  TrainResult run(const std::vector<dataset::Example>& train, const std::vector<dataset::Example>& validation,
                  const std::function<void(const TrainReport&)>& report, const std::function<bool()>& stop);

  Model& model() { return model_; }
  std::int64_t steps() const { return step_; }
  const StepProfile& profile() const { return profile_; }  // of run(), since this object was made

 private:
  double progress() const;
  double learning_rate() const;
  std::map<std::string, double> step(BatchesAhead& batches);
  NormRule norm_rule() const;
  Variations variations_of(const std::vector<dataset::Example>& train) const;
  dataset::Batch batch_of(Variations& variations, std::uint64_t number) const;
  void keep_if_best(const std::map<std::string, double>& figures);
  void save() const;

  Task task_;
  TrainOptions options_;
  Model model_;
  Adam adam_;
  std::int64_t step_ = 0;
  double seconds_ = 0.0;
  struct Best {
    std::map<std::string, double> figures;
    Model model;
  };
  std::optional<Best> best_;  // so far, where the best is kept
  StepProfile profile_;
};

}  // namespace osteon::train
