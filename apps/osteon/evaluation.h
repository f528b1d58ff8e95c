// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "osteon/dataset/manifest.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/metrics/connectivity_metrics.h"
#include "osteon/metrics/skeleton_metrics.h"
#include "osteon/metrics/skin_metrics.h"
#include "osteon/pipelines/rignet.h"
#include "osteon/rig/rig.h"

namespace osteon::app {

// A rig as it should be, in the frame of the measures: longest side 1.
struct Reference {
  Rig rig;
  geometry::Normalization normalization;
  PerJoint<float> tolerances;

  explicit Reference(Rig loaded);

  // `predicted` is in world space of the file that the reference came from; `tolerance_scale` 1 is RigNet's measure.
  Skeleton in_frame(Skeleton predicted) const;
  metrics::SkeletonScores skeleton_scores(const Skeleton& predicted, float tolerance_scale = 1.0f) const;
  metrics::SkinScores skin_scores(const SkinWeights& predicted) const;
};

// A character of a data folder, as its file has it and as a reference.
struct Subject {
  dataset::CharacterInfo info;
  Rig rig;
  Reference reference;
};

// Calls work(i, character) for every character of the split, in parallel. One bad character does not stop the others: "id: reason" for
// each that failed. `prepare` is told how many there will be.
std::vector<std::string> for_each_character(const std::filesystem::path& data, const std::string& split,
                                            const std::function<void(std::size_t)>& prepare,
                                            const std::function<void(std::size_t, const Subject&)>& work);

// The reference's joints, those at one place merged as for training, connected by the networks.
metrics::ConnectivityScores connectivity_scores(const Rig& rig, const infer::RignetModels& models, const pipelines::RignetOptions& options);

// Skin for the reference's skeleton, as in RigNet's table 2.
metrics::SkinScores skin_scores(const Subject& subject, const infer::RignetModels& models, pipelines::RignetOptions options);

}  // namespace osteon::app
