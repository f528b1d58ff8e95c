// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "osteon/train/trainer.h"

// Trained weights made to fit a few characters of one's own.
namespace osteon::train {

struct FinetuneData {
  std::vector<dataset::PreparedCharacter> own, validation;
  std::vector<dataset::PreparedCharacter> general;  // may be empty; else half of what is shown, so that what was known is not forgotten
};

struct FinetuneOptions {
  std::filesystem::path init;         // folder with the weights to start from: {votes,bind,tree}.safetensors, perhaps neuroskinning
  std::filesystem::path output;       // folder where the tuned ones go; exists
  std::filesystem::path checkpoints;  // folder where the state of a network in training is kept; exists
  double minutes = 0.0;               // of training, of all networks together ...
  std::int64_t steps = 0;             // ... or steps of each (0: by time)
  std::uint64_t seed = 1;
  RunOptions run;
  double report_seconds = 0.5;
  std::map<std::string, std::string> metadata;  // for the weights, beside what the training says of itself
};

// Validation figures of the weights before and after, as the files have them: see validate(). Empty where there is nothing to learn from:
// such weights are copied.
struct FinetunedNetwork {
  std::string name;
  std::map<std::string, double> before, after;
};

// Tunes the voting, the binding, NeuroSkinning's (with the super skeleton that it has) and the tree network in turn, those that `init` has;
// the second voting network is left out, as two tuned in the time of one vote no better (docs/training.md). Of each the state with the
// smallest validation loss is kept, never one worse than before. A network whose file is in `output` is finished, one with a checkpoint is
// gone on with, so that a stopped run goes on as if it had not been stopped (by steps; by time it depends on the speed).
// Throws Cancelled, with a checkpoint written, when `stop` says so; Error where NeuroSkinning's weights have no super skeleton.
std::vector<FinetunedNetwork> finetune(const FinetuneData& data, const FinetuneOptions& options,
                                       const std::function<void(const std::string& network, const TrainReport&)>& report,
                                       const std::function<bool()>& stop);

}  // namespace osteon::train
