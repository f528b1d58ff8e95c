// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <vector>

#include "osteon/geometry/joint_rays.h"
#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/rignet_features.h"
#include "osteon/geometry/symmetry.h"
#include "osteon/geometry/volumetric_geodesic.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/synth/character.h"

// What geometry computes for the networks, on the working mesh of a procedural biped with `vertices` vertices.
namespace osteon::geometry {
namespace {

struct Subject {
  TriangleMesh mesh;  // normalised
  std::vector<Vec3f> joints;
  std::vector<int> parents;
  std::vector<Segment> bones;
  std::vector<int> starts;  // joints of the bones
};

Subject subject(std::int64_t vertices) {
  const Rig rig = synth::make_character(synth::Kind::Biped, 1, {.cells = 160, .finish = synth::Finish::Smooth});
  WorkingMesh working = make_working_mesh(rig.mesh, {.target_vertices = static_cast<std::size_t>(vertices)});
  Subject out{std::move(working.mesh), {}, {}, {}, {}};
  for (JointId j : rig.skeleton.names.ids()) {
    out.joints.push_back(working.normalization.apply(rig.skeleton.rest_positions[j]));
    out.parents.push_back(rig.skeleton.parents[j] ? static_cast<int>(*rig.skeleton.parents[j]) : -1);
  }
  for (const Bone& bone : bones(rig.skeleton)) {
    out.bones.push_back({working.normalization.apply(bone.segment.a), working.normalization.apply(bone.segment.b)});
    out.starts.push_back(static_cast<int>(bone.start));
  }
  return out;
}

void run(benchmark::State& state, auto compute) {
  const Subject s = subject(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(compute(s));
  state.counters["bones"] = static_cast<double>(s.bones.size());
}

void balls(benchmark::State& state) {
  run(state, [](const Subject& s) { return geodesic_balls(s.mesh); });
}
void voxels(benchmark::State& state) {
  run(state, [](const Subject& s) { return voxelize(s.mesh); });
}
void distances(benchmark::State& state) {
  run(state, [](const Subject& s) { return volumetric_geodesic_distance(s.mesh, voxelize(s.mesh), s.bones); });
}
void nearest_distances(benchmark::State& state) {
  run(state, [](const Subject& s) { return volumetric_geodesic_distance(s.mesh, voxelize(s.mesh), s.bones, {s.starts, 8}); });
}
void symmetry(benchmark::State& state) {
  run(state, [](const Subject& s) { return symmetry_plane(s.mesh); });
}
void labels(benchmark::State& state) {
  run(state, [](const Subject& s) { return attention_labels(s.mesh, s.joints, s.parents); });
}
void pairs(benchmark::State& state) {
  run(state, [](const Subject& s) { return pair_features(s.joints, voxelize(s.mesh)); });
}

BENCHMARK(balls)->Arg(1200)->Arg(4000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(voxels)->Arg(1200)->Arg(4000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(distances)->Arg(1200)->Arg(4000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(nearest_distances)->Arg(1200)->Arg(4000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(symmetry)->Arg(1200)->Arg(4000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(labels)->Arg(1200)->Arg(4000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(pairs)->Arg(1200)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace osteon::geometry
