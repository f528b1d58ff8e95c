// SPDX-License-Identifier: Apache-2.0
// limits MODELS [RUNS]: where the time of `osteon rig` goes on a generated biped of 6,628 vertices, and how far each stage is from what the
// machine can do. Work: multiplications and additions where a stage computes (the products of the networks, the kernels of the mean shift),
// else the bytes of what it reads and writes, each counted once, which no program can do without. Limit: the rate of a plain oneDNN product
// or of a copy in memory on as many threads, measured in the same run. Median of RUNS (11).
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <map>

#include "apps/kept_memory.h"
#include "infer/flop_counter.h"
#include "infer/product_rate.h"
#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/geometry/symmetry.h"
#include "osteon/geometry/vote_features.h"
#include "osteon/geometry/voxel_grid.h"
#include "osteon/pipelines/joint_votes.h"
#include "osteon/pipelines/mean_shift.h"
#include "osteon/pipelines/neuroskinning.h"
#include "osteon/pipelines/rignet.h"
#include "osteon/synth/character.h"

namespace osteon {
namespace {

using nets::rignet::Network;

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

// GB/s of reading one half of 256 MB and writing the other, both counted, on all threads.
double copy_rate() {
  constexpr std::size_t bytes = 128u << 20, grain = 1u << 20;
  static std::vector<char> from(bytes, 1), to(bytes, 0);
  std::vector<double> seconds;
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    parallel_for(bytes, grain, [&](std::size_t begin, std::size_t end) { std::memcpy(&to[begin], &from[begin], end - begin); });
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return 2e-9 * bytes / median(seconds);
}

struct Work {
  double gflop = 0.0, gigabytes = 0.0;
};

double gigabytes(std::size_t items, std::size_t size) { return 1e-9 * static_cast<double>(items * size); }
double bytes_of(const TriangleMesh& mesh) { return gigabytes(mesh.positions.size(), 12) + gigabytes(mesh.faces.size(), 12); }
double bytes_of(const geometry::Neighbourhoods& n) { return gigabytes(n.offsets.size() + n.members.size(), 4); }

// Of the joints' stage: 19 operations for each point that moves and point within the bandwidth, in every round of the mean shift.
double gflop_of_mean_shift(const pipelines::JointCandidates& seen, const geometry::VoxelGrid& voxels, const Plane& plane, float bandwidth) {
  std::vector<Vec3f> points;
  std::vector<float> weights;
  for (std::size_t i = 0; i < seen.positions.size(); ++i) {
    Vec3f p = seen.positions[i];
    if (!voxels.inside(p) || seen.attention[i] < pipelines::JointExtractionOptions().min_attention) continue;
    p.x() = plane.signed_distance(p);
    points.push_back(p);
    weights.push_back(seen.attention[i]);
  }
  double pairs = 0.0;
  const pipelines::MeanShiftOptions once{.bandwidth = bandwidth, .most_iterations = 1};
  std::vector<bool> rests(points.size(), false);
  for (bool done = false; !done;) {
    std::vector<double> near(points.size(), 0.0);
    parallel_for(points.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (const Vec3f& p : points)
          for (const float side : {1.0f, -1.0f})
            near[i] += (Vec3f(side * p.x(), p.y(), p.z()) - points[i]).squaredNorm() < bandwidth * bandwidth ? 1.0 : 0.0;
    });
    const auto moved = pipelines::mean_shift(points, weights, pipelines::Mirror::across_x, once);
    done = true;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (rests[i]) continue;
      pairs += near[i];
      const float move = (moved.points[i] - points[i]).norm();
      done = done && move <= once.tolerance;
      rests[i] = move < pipelines::JointExtractionOptions().rest;
      points[i] = moved.points[i];
    }
  }
  return 19e-9 * pairs;
}

// What each stage has to do, by its name in the report.
std::map<std::string, Work> work_of(const TriangleMesh& mesh, const infer::RignetModels& models, const pipelines::RignetResult& result) {
  const geometry::WorkingMesh working = geometry::make_working_mesh(mesh);
  const geometry::Neighbourhoods ring = geometry::one_ring(working.mesh);
  const geometry::GeodesicBalls balls = geometry::geodesic_balls(working.mesh);
  const geometry::Neighbourhoods geodesic = geometry::evenly(balls, 10);
  const geometry::Regions regions = geometry::regions(working.mesh, balls, nets::vote_regions, geometry::outermost_vertex(working.mesh));
  const geometry::VoxelGrid voxels = geometry::voxelize(working.mesh);
  const std::vector<Vec3f>& positions = working.mesh.positions.raw();
  const std::size_t v = positions.size(), joints = result.skeleton.size(), bones = osteon::bones(result.skeleton).size();

  // Only the sizes count.
  const nets::MeshArrays graph = infer::single_mesh(positions, {ring.offsets, ring.members}, {geodesic.offsets, geodesic.members});
  nets::VoteArrays votes;
  votes.add(std::vector<float>(v * nets::vote_features), regions.seeds, regions.region_of, 0);
  const std::vector<Vec3f> places(joints, Vec3f::Zero());
  const nets::JointArrays skeleton = infer::single_skeleton(places, std::vector<float>(joints, 0.0f));
  nets::TreeArrays tree;
  tree.add(std::vector<float>(joints * nets::tree_joint_features), std::vector<float>(joints * joints * nets::tree_pair_features));
  nets::BindArrays choices;
  const auto each = static_cast<std::int32_t>(std::min<std::size_t>(geometry::kBindBones, bones));
  std::vector<std::int32_t> offsets{0}, of_bones;
  for (std::size_t i = 0; i < v; ++i) {
    offsets.push_back(offsets.back() + each);
    for (std::int32_t b = 0; b < each; ++b) of_bones.push_back(static_cast<std::int32_t>((i + static_cast<std::size_t>(b)) % bones));
  }
  choices.add(std::vector<float>(of_bones.size() * nets::bind_features), offsets, of_bones);
  const infer::NetworkInput input{graph, &skeleton, nullptr, {}, &choices, &votes, &tree};
  const auto gflop_of = [](Network network, const infer::NetworkInput& of) { return 1e-9 * bench::flop_of(network, of); };
  const auto gflop = [&](Network network) { return gflop_of(network, input); };

  const geometry::Neighbourhoods near = pipelines::neuroskinning_neighbours(working.mesh);
  Skeleton placed = result.skeleton;
  for (Vec3f& p : placed.rest_positions) p = working.normalization.apply(p);
  const auto second = pipelines::neuroskinning_inputs(working.mesh, ring, near, placed, *models.neuroskinning());
  const auto plane = geometry::symmetry_plane(working.mesh);
  const auto seen = pipelines::joint_votes(working.mesh, graph, regions, models, pipelines::expected_joints(mesh.faces.size(), 0.5f));
  return {{"body frame", {.gigabytes = gigabytes(mesh.positions.size(), 12)}},
          {"working mesh", {.gigabytes = bytes_of(mesh) + bytes_of(working.mesh)}},
          {"symmetry", {.gigabytes = bytes_of(working.mesh)}},
          {"mirror pairs", {.gigabytes = bytes_of(mesh)}},
          {"neighbourhoods", {.gigabytes = bytes_of(working.mesh) + bytes_of(balls.members) + gigabytes(balls.distances.size(), 4)}},
          {"regions", {.gigabytes = bytes_of(balls.members) + gigabytes(balls.distances.size(), 4)}},
          {"voxels", {.gigabytes = bytes_of(working.mesh) + gigabytes(88 * 88 * 88, 1)}},
          {"joint networks", {.gflop = 4.0 * gflop(Network::votes)}},  // four views
          {"joints",
           {.gflop = gflop_of_mean_shift(seen, voxels, plane.value_or(Plane{Vec3f::UnitX(), 0.0f}),
                                         result.report.bandwidth.value_or(pipelines::kDefaultBandwidth))}},
          {"connectivity networks", {.gflop = gflop(Network::tree)}},
          {"tree", {.gigabytes = gigabytes(joints * joints, 4)}},
          {"bone distances", {.gigabytes = bytes_of(working.mesh) + gigabytes(v * bones, 4)}},
          {"skin network", {.gflop = gflop(Network::bind)}},
          {"wide neighbourhoods", {.gigabytes = bytes_of(working.mesh) + bytes_of(near)}},
          {"joint choices", {.gigabytes = bytes_of(working.mesh) + gigabytes(second.joint_of_row.size(), 8)}},
          {"second network", {.gflop = gflop_of(Network::neuroskinning, {.mesh = second.graph, .neuro = &second.neuro})}},
          {"weights", {.gigabytes = gigabytes(v * joints, 4) + gigabytes(mesh.positions.size() * 4, 8)}}};
}

void run(const std::filesystem::path& folder, int runs) {
  const infer::RignetModels models = infer::RignetModels::load(folder);
  const TriangleMesh mesh = synth::make_character(synth::Kind::Biped, 3, {82, synth::Finish::Smooth}).mesh;
  std::vector<std::string> order;
  std::map<std::string, std::vector<double>> seconds;
  std::vector<double> product, copy;
  pipelines::RignetResult result;
  for (int i = 0; i < runs; ++i) {
    result = pipelines::rig_character(mesh, models);
    for (const auto& stage : result.report.stages) {
      if (i == 0 && !seconds.contains(stage.stage)) order.push_back(stage.stage);
      seconds[stage.stage].push_back(stage.seconds);
    }
    product.push_back(threads() * bench::plain_product_rate());
    copy.push_back(copy_rate());
  }
  double whole = 0.0;
  for (const auto& [name, times] : seconds) whole += median(times);
  const auto work = work_of(mesh, models, result);
  fmt::print("{} vertices, {} threads; products at {:.0f} GFLOP/s, copies at {:.1f} GB/s\n\n", mesh.positions.size(), threads(),
             median(product), median(copy));
  fmt::print("| stage | ms | of the time % | work | rate | of the limit % |\n|---|---|---|---|---|---|\n");
  Work networks;
  double in_networks = 0.0;
  for (const std::string& name : order) {
    const double time = median(seconds[name]);
    const Work& w = work.at(name);
    const bool computes = w.gflop > 0.0;
    if (name.ends_with("network") || name.ends_with("networks")) {
      networks.gflop += w.gflop;
      in_networks += time;
    }
    const double amount = computes ? w.gflop : w.gigabytes, rate = amount / time;
    fmt::print("| {} | {:.1f} | {:.0f} | {:.3g} {} | {:.3g} {}/s | {:.2g} |\n", name, 1e3 * time, 100.0 * time / whole,
               computes ? amount : 1e3 * amount, computes ? "GFLOP" : "MB", rate, computes ? "GFLOP" : "GB",
               100.0 * rate / median(computes ? product : copy));
  }
  fmt::print("| all | {:.1f} | 100 | | | |\n", 1e3 * whole);
  fmt::print("| of these the networks | {:.1f} | {:.0f} | {:.3g} GFLOP | {:.3g} GFLOP/s | {:.2g} |\n", 1e3 * in_networks,
             100.0 * in_networks / whole, networks.gflop, networks.gflop / in_networks,
             100.0 * networks.gflop / in_networks / median(product));
}

}  // namespace
}  // namespace osteon

int main(int argc, char** argv) {
  osteon::app::keep_freed_memory();  // as the program does
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: limits MODELS [RUNS]\n");
    return 2;
  }
  try {
    osteon::run(argv[1], argc > 2 ? std::stoi(argv[2]) : 11);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}
