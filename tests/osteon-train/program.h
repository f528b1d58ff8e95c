// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "osteon/dataset/prepared.h"
#include "osteon/synth/character.h"
#include "support/program.h"

namespace osteon::test {

// Runs `osteon-train ARGUMENTS` through the shell in the folder.
inline Outcome osteon_train(const TemporaryFolder& folder, const std::string& arguments) {
  return run_in(folder, fmt::format("export OSTEON_MODELS={}; {} {}", OSTEON_MODELS_FOLDER, OSTEON_TRAIN_PROGRAM, arguments));
}

// Of characters that are made quickly.
inline synth::CharacterOptions coarse() {
  synth::CharacterOptions options;
  options.cells = 40;
  return options;
}

// Bipeds of the seeds 1, 2, ... on small working meshes.
inline std::vector<dataset::PreparedCharacter> prepared_bipeds(std::uint64_t count) {
  dataset::PrepareOptions options;
  options.working_mesh = {300, 200, 5000};
  std::vector<dataset::PreparedCharacter> out;
  for (std::uint64_t seed = 1; seed <= count; ++seed)
    out.push_back(dataset::prepare(synth::make_character(synth::Kind::Biped, seed, coarse()), {std::to_string(seed), "", "own"}, options));
  return out;
}

}  // namespace osteon::test
