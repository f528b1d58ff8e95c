// SPDX-License-Identifier: Apache-2.0
#include "gallery.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <numbers>

#include "contact_sheet.h"
#include "evaluation.h"

namespace osteon::app {
namespace {

constexpr std::size_t kShown = 10;
constexpr int kTile = 200, kTiles = 4, kColumns = 2, kGap = 8;  // pixels; pictures of a character; characters in a row; between them
constexpr float kPitch = 0.12f;
const Vec3f kClay(0.5f, 0.5f, 0.5f);

struct Case {
  dataset::CharacterInfo info;
  TriangleMesh mesh;
  Skeleton reference, ours;
  metrics::SkeletonScores scores;
};

render::Image picture_of(const Case& one) {
  const PerVertex<Vec3f> colors(one.mesh.positions.size(), kClay);
  render::Image row(kTiles * kTile, kTile);
  int x = 0;
  for (const Skeleton* skeleton : {&one.reference, &one.ours})
    for (const float yaw : {0.0f, -0.5f * std::numbers::pi_v<float>}) {
      render::paste(row, tile_picture(one.mesh, colors, *skeleton, {yaw, kPitch}, kTile), x, 0);
      x += kTile;
    }
  return row;
}

render::Image sheet_of(const std::vector<Case>& cases) {
  const int rows = (static_cast<int>(cases.size()) + kColumns - 1) / kColumns;
  const int width = kTiles * kTile + kGap, height = kTile + kGap;
  render::Image sheet(kColumns * width - kGap, rows * height - kGap);
  std::ranges::fill(sheet.pixels, std::array<std::uint8_t, 3>{255, 255, 255});
  for (int i = 0; i < static_cast<int>(cases.size()); ++i)
    render::paste(sheet, picture_of(cases[static_cast<std::size_t>(i)]), i % kColumns * width, i / kColumns * height);
  return sheet;
}

}  // namespace

std::string save_gallery(const std::filesystem::path& picture, const std::filesystem::path& data, const std::string& split,
                         const infer::RignetModels& models, const pipelines::RignetOptions& options) {
  std::vector<Case> cases;
  const auto failures = for_each_character(
      data, split, [&](std::size_t count) { cases.resize(count); },
      [&](std::size_t i, const Subject& subject) {
        const Skeleton ours = pipelines::rig_character(subject.rig.mesh, models, options).skeleton;
        cases[i] = {subject.info, subject.rig.mesh, subject.rig.skeleton, ours, subject.reference.skeleton_scores(ours)};
      });
  for (const std::string& failure : failures) spdlog::warn("left out: {}", failure);
  std::erase_if(cases, [](const Case& one) { return one.info.id.empty(); });
  std::ranges::stable_sort(cases, {}, [](const Case& one) { return one.scores.iou; });
  cases.resize(std::min(cases.size(), kShown));
  render::save_png(picture, sheet_of(cases));
  std::string list;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto& [info, mesh, reference, ours, scores] = cases[i];
    list += fmt::format("{}. {} ({}): IoU {:.0f} %, precision {:.0f} %, recall {:.0f} %; {} joints for {}\n", i + 1, info.id, info.category,
                        100.0 * scores.iou, 100.0 * scores.precision, 100.0 * scores.recall, ours.size(), reference.size());
  }
  return list;
}

}  // namespace osteon::app
