// SPDX-License-Identifier: Apache-2.0
#include "evaluation_plots.h"

#include <spdlog/spdlog.h>

#include <array>

#include "evaluation.h"
#include "osteon/base/error.h"
#include "osteon/metrics/line_plot.h"

namespace osteon::app {
namespace {

using pipelines::RignetOptions;

constexpr std::array kToleranceScales{0.25f, 0.5f, 0.75f, 1.0f, 1.25f, 1.5f, 2.0f, 2.5f, 3.0f};
constexpr std::array kDetails{0.0f, 0.125f, 0.25f, 0.375f, 0.5f, 0.625f, 0.75f, 0.875f, 1.0f};
constexpr std::array kCounts{1, 2, 3, 4, 5, 6, 7, 8};

// One character's measures along each axis.
struct Curves {
  std::vector<metrics::SkeletonScores> tolerances, details;
  std::vector<metrics::SkinScores> influences, bones;
};

Curves curves_of(const Subject& subject, const infer::RignetModels& models) {
  const auto skeleton = [&](float detail) {
    RignetOptions options;
    options.detail = detail;
    return pipelines::rig_character(subject.rig.mesh, models, options).skeleton;
  };
  Curves out;
  const Skeleton usual = skeleton(RignetOptions().detail);
  for (const float scale : kToleranceScales) out.tolerances.push_back(subject.reference.skeleton_scores(usual, scale));
  for (const float detail : kDetails) out.details.push_back(subject.reference.skeleton_scores(skeleton(detail)));
  for (const int count : kCounts) {
    RignetOptions influences, bones;
    influences.skin.max_influences = static_cast<std::size_t>(count);
    bones.ablation.bones = count;
    out.influences.push_back(skin_scores(subject, models, influences));
    out.bones.push_back(skin_scores(subject, models, bones));
  }
  return out;
}

// The mean over the characters of one measure, times `factor`, at each place of an axis.
template <class Places, class Scores>
metrics::PlotLine mean_line(std::string name, const std::vector<Curves>& all, const Places& places, std::vector<Scores> Curves::*curve,
                            double Scores::*measure, double factor = 100.0) {
  metrics::PlotLine line{std::move(name), {}};
  for (std::size_t k = 0; k < places.size(); ++k) {
    double sum = 0.0;
    for (const Curves& one : all) sum += (one.*curve)[k].*measure;
    line.points.emplace_back(static_cast<double>(places[k]), factor * sum / static_cast<double>(all.size()));
  }
  return line;
}

template <class Places>
std::vector<metrics::PlotLine> joint_lines(const std::vector<Curves>& all, const Places& places,
                                           std::vector<metrics::SkeletonScores> Curves::*curve) {
  using S = metrics::SkeletonScores;
  return {mean_line("IoU", all, places, curve, &S::iou), mean_line("precision", all, places, curve, &S::precision),
          mean_line("recall", all, places, curve, &S::recall)};
}

std::vector<metrics::PlotLine> skin_lines(const std::vector<Curves>& all, std::vector<metrics::SkinScores> Curves::*curve) {
  using S = metrics::SkinScores;
  return {mean_line("precision", all, kCounts, curve, &S::precision), mean_line("recall", all, kCounts, curve, &S::recall),
          mean_line("100 × L1", all, kCounts, curve, &S::l1)};
}

}  // namespace

void save_evaluation_plots(const std::filesystem::path& folder, const std::filesystem::path& data, const std::string& split,
                           const infer::RignetModels& models) {
  std::vector<Curves> all;
  const auto failures = for_each_character(
      data, split, [&](std::size_t count) { all.resize(count); },
      [&](std::size_t i, const Subject& subject) { all[i] = curves_of(subject, models); });
  for (const std::string& failure : failures) spdlog::warn("left out: {}", failure);
  std::erase_if(all, [](const Curves& one) { return one.bones.empty(); });
  if (all.empty()) throw Error("{}: no character of split '{}' could be measured", data.string(), split);

  using S = metrics::SkeletonScores;
  const metrics::PlotAxis percent{"%", 0.0, 100.0}, of_skin{"% (L1: times 100)", 0.0}, detail{"--detail: 0 few joints, 1 many", 0.0, 1.0};
  metrics::save_svg(folder / "tolerance.svg", {"Joints found, by how near is near enough",
                                               {"tolerance, in parts of half the local diameter", 0.0, 3.0},
                                               percent,
                                               joint_lines(all, kToleranceScales, &Curves::tolerances)});
  metrics::save_svg(folder / "detail.svg",
                    {"Joints found, by the level of detail", detail, percent, joint_lines(all, kDetails, &Curves::details)});
  metrics::save_svg(folder / "detail_distances.svg", {"Distance to the reference, by the level of detail",
                                                      detail,
                                                      {"% of the longest side", 0.0},
                                                      {mean_line("CD-J2J", all, kDetails, &Curves::details, &S::cd_j2j),
                                                       mean_line("CD-J2B", all, kDetails, &Curves::details, &S::cd_j2b),
                                                       mean_line("CD-B2B", all, kDetails, &Curves::details, &S::cd_b2b)}});
  metrics::save_svg(folder / "influences.svg", {"Skin, by the joints that may move a vertex",
                                                {"joints that may move a vertex (--max-influences)", 1.0, 8.0},
                                                of_skin,
                                                skin_lines(all, &Curves::influences)});
  metrics::save_svg(folder / "bones.svg", {"Skin, by the bones that a vertex chooses from",
                                           {"nearest bones that a vertex chooses from", 1.0, 8.0},
                                           of_skin,
                                           skin_lines(all, &Curves::bones)});
}

}  // namespace osteon::app
