// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "cut_bones.h"
#include "osteon/pipelines/neuroskinning.h"
#include "osteon/skin/bind.h"
#include "osteon/synth/character.h"

// Binding a procedural biped, by the vertices of its mesh and by its bones.
namespace osteon::skin {
namespace {

Rig biped(std::int64_t cells) { return synth::make_character(synth::Kind::Biped, 3, {static_cast<int>(cells), synth::Finish::Smooth}); }

void by_vertices(benchmark::State& state) {
  const Rig rig = biped(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(bind(rig.mesh, rig.skeleton));
  state.counters["vertices"] = static_cast<double>(rig.mesh.positions.size());
}
void by_bones(benchmark::State& state) {
  const Rig rig = biped(96);
  const Skeleton skeleton = bench::with_bones_cut(rig.skeleton, static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(bind(rig.mesh, skeleton));
  state.counters["joints"] = static_cast<double>(skeleton.size());
}
void by_method(benchmark::State& state) {
  const Rig rig = biped(96);
  BindOptions options;
  options.method = static_cast<Method>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(bind(rig.mesh, rig.skeleton, options));
}

// By the shipped network, loading it not included: about 5,000 vertices and, cut in two, 60 joints.
void by_neuroskinning(benchmark::State& state) {
  const infer::NeuroskinningModel model = infer::NeuroskinningModel::load();
  const Rig rig = biped(72);
  const Skeleton skeleton = bench::with_bones_cut(rig.skeleton, static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(pipelines::neuroskinning_weights(rig.mesh, skeleton, model));
  state.counters["vertices"] = static_cast<double>(rig.mesh.positions.size());
  state.counters["joints"] = static_cast<double>(skeleton.size());
}

BENCHMARK(by_vertices)->Arg(64)->Arg(128)->Arg(256)->Arg(400)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(by_bones)->Arg(1)->Arg(2)->Arg(4)->Arg(8)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(by_neuroskinning)->Arg(1)->Arg(2)->Arg(4)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(by_method)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace osteon::skin
