// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cmath>

#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "osteon/pipelines/joint_extraction.h"
#include "osteon/pipelines/mean_shift.h"
#include "osteon/pipelines/skeleton_tree.h"
#include "osteon/pipelines/skin_prediction.h"

// Everything between the networks, on a character of `vertices` working vertices whose candidates gather around 40 places.
namespace osteon::pipelines {
namespace {

JointCandidates candidates(std::int64_t vertices) {
  Random random(1);
  std::vector<Vec3f> centres;
  for (int k = 0; k < 20; ++k) {
    centres.emplace_back(random.uniform(0.0f, 0.5f), random.uniform(), random.uniform(-0.1f, 0.1f));
    centres.emplace_back(-centres.back().x(), centres.back().y(), centres.back().z());
  }
  JointCandidates out;
  for (std::int64_t v = 0; v < vertices; ++v) {
    out.positions.push_back(centres[random.below(centres.size())] + 0.02f * Vec3f(random.normal(), random.normal(), random.normal()));
    out.attention.push_back(random.uniform());
  }
  return out;
}

void mean_shift_by_grid(benchmark::State& state) {
  const JointCandidates seen = candidates(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(mean_shift(seen.positions, seen.attention, Mirror::across_x, {}));
}
BENCHMARK(mean_shift_by_grid)->Arg(1200)->Arg(4000)->Unit(benchmark::kMillisecond)->UseRealTime();

// One iteration's pair sums as a plain program has them: what the grid has to beat.
void all_pairs_once(benchmark::State& state) {
  JointCandidates seen = candidates(state.range(0));
  const std::size_t n = seen.positions.size();
  for (std::size_t i = 0; i < n; ++i) seen.positions.emplace_back(-seen.positions[i].x(), seen.positions[i].y(), seen.positions[i].z());
  for (auto _ : state)
    for (std::size_t j = 0; j < n; ++j) {
      float sum = 0.0f;
      for (const Vec3f& p : seen.positions) sum += std::max(0.0f, 0.0429f * 0.0429f - (p - seen.positions[j]).squaredNorm());
      benchmark::DoNotOptimize(sum);
    }
}
BENCHMARK(all_pairs_once)->Arg(1200)->Arg(4000)->Unit(benchmark::kMillisecond)->UseRealTime();

void extract(benchmark::State& state) {
  const JointCandidates seen = candidates(state.range(0));
  const geometry::VoxelGrid everything{};  // holds nothing, so the inside test is left out
  for (auto _ : state) benchmark::DoNotOptimize(extract_joints(seen, everything, Plane{Vec3f::UnitX(), 0.0f}));
}
BENCHMARK(extract)->Arg(1200)->Arg(4000)->Unit(benchmark::kMillisecond)->UseRealTime();

void finish(benchmark::State& state) {
  const TriangleMesh mesh = shapes::icosphere(static_cast<int>(state.range(0)));
  const geometry::WorkingMesh working = geometry::make_working_mesh(mesh);
  Random random(2);
  Matrix raw(static_cast<Eigen::Index>(working.mesh.positions.size()), 40);
  for (float& w : raw.reshaped<Eigen::RowMajor>()) w = std::pow(random.uniform(), 8.0f);
  const auto ring = geometry::one_ring(working.mesh);
  Skeleton skeleton;
  for (std::uint16_t j = 0; j < 40; ++j)
    skeleton.add(std::to_string(j), j > 0 ? std::optional(static_cast<JointId>(j - 1)) : std::nullopt,
                 Vec3f(0, 0, static_cast<float>(j) / 40.0f));
  for (auto _ : state) benchmark::DoNotOptimize(finish_weights(raw, working, ring, skeleton));
  state.SetLabel(std::to_string(mesh.positions.size()) + " vertices");
}
BENCHMARK(finish)->Arg(4)->Arg(7)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace osteon::pipelines
