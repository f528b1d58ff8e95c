// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cmath>

#include "geometry/mesh_makers.h"
#include "osteon/geometry/bvh.h"
#include "osteon/geometry/cleanup.h"
#include "osteon/geometry/decimate.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/mesh/shapes.h"

// From a scan of 1.3 million triangles to the working mesh and back.
namespace osteon::geometry {
namespace {

// A sphere with bumps and noise, vertices and faces in random order.
TriangleMesh scan() {
  TriangleMesh mesh = shapes::icosphere(8);
  Random random(3);
  for (Vec3f& p : mesh.positions) p *= 1 + 0.002f * random.normal() + 0.1f * std::sin(5 * p.x()) * std::cos(7 * p.y());
  return test::shuffled(mesh, 1);
}

void run(benchmark::State& state, const auto& subject, auto compute) {
  for (auto _ : state) benchmark::DoNotOptimize(compute(subject));
  state.SetLabel("1.3 million triangles");
}

void clean_indexed(benchmark::State& state) { run(state, scan(), clean); }
void clean_separate(benchmark::State& state) { run(state, test::unshared(scan()), clean); }
void tree(benchmark::State& state) {
  run(state, scan(), [](const TriangleMesh& mesh) { return Bvh(mesh); });
}
void reduce(benchmark::State& state) {
  run(state, clean(scan()).mesh, [](const TriangleMesh& mesh) { return decimate(mesh, {}); });
}
void working_mesh(benchmark::State& state) {
  run(state, scan(), [](const TriangleMesh& mesh) { return make_working_mesh(mesh); });
}
void back(benchmark::State& state) { run(state, make_working_mesh(scan()), carry_back); }

BENCHMARK(clean_indexed)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(clean_separate)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(tree)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(reduce)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(working_mesh)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(back)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace osteon::geometry
