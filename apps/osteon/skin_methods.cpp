// SPDX-License-Identifier: Apache-2.0
#include "skin_methods.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "evaluation.h"
#include "osteon/base/error.h"
#include "osteon/pipelines/skin_character.h"

namespace osteon::app {
namespace {

struct NamedMethod {
  const char* name;
  std::optional<skin::Method> method;  // empty: networks
};
constexpr std::array<NamedMethod, 7> kMethods{{{"rigid", skin::Method::rigid},
                                               {"geovoxel", skin::Method::geovoxel},
                                               {"heat", skin::Method::heat},
                                               {"biharmonic", skin::Method::biharmonic},
                                               {"rignet", std::nullopt},
                                               {"neuroskinning", std::nullopt},
                                               {"networks", std::nullopt}}};

SkinWeights weights_by(const NamedMethod& method, const Rig& rig, const infer::RignetModels& models) {
  pipelines::SkinCharacterOptions options;
  if (method.method)
    options.bind.method = *method.method;
  else {
    const std::string_view name = method.name;
    if (name != "neuroskinning") options.rignet = &models;
    if (name != "rignet") options.neuroskinning = models.neuroskinning();
  }
  SkinWeights weights = pipelines::skin_character(rig.mesh, rig.skeleton, options).weights;
  validate(weights, rig.mesh.positions.size(), rig.skeleton.size());
  return weights;
}

std::vector<double> values(const metrics::SkinScores& s) { return {s.precision, s.recall, s.l1, s.mean_distance, s.max_distance}; }

}  // namespace

metrics::ScoreTable skin_methods_table(const std::filesystem::path& data, const std::string& split, const infer::RignetModels& models,
                                       const std::vector<metrics::ScoreColumn>& columns) {
  if (!models.neuroskinning()) throw Error("skin-methods: the models have no neuroskinning.safetensors, expected all networks");
  struct Outcome {
    std::vector<metrics::ScoreRow> rows;
    std::vector<std::string> failures;
  };
  std::vector<Outcome> outcomes;
  metrics::ScoreTable table{"skin weights by method, skeleton given", columns, {}, {}};
  table.failures = for_each_character(
      data, split, [&](std::size_t count) { outcomes.resize(count); },
      [&](std::size_t i, const Subject& subject) {
        for (const NamedMethod& method : kMethods) try {
            const SkinWeights weights = weights_by(method, subject.rig, models);
            outcomes[i].rows.push_back({subject.info.id, method.name, values(subject.reference.skin_scores(weights))});
          } catch (const Error& e) {
            outcomes[i].failures.push_back(fmt::format("{}: {}: {}", subject.info.id, method.name, e.what()));
          }
      });
  for (Outcome& outcome : outcomes) {
    table.rows.insert(table.rows.end(), outcome.rows.begin(), outcome.rows.end());
    table.failures.insert(table.failures.end(), outcome.failures.begin(), outcome.failures.end());
  }
  return table;
}

}  // namespace osteon::app
