// SPDX-License-Identifier: Apache-2.0
// Each network of RigNet on a regular mesh with 6 one-ring and 10 geodesic neighbours: wall time, GFLOP/s of one core (by the process's own
// processor time, so that other load on the machine counts little), and that rate as a share of a plain oneDNN product's in the same run.
#include <benchmark/benchmark.h>
#include <omp.h>
#include <time.h>

#include <chrono>
#include <cmath>
#include <oneapi/dnnl/dnnl.hpp>

#include "infer/examples.h"
#include "osteon/infer/onednn_backend.h"
#include "osteon/infer/rignet.h"

namespace osteon::infer {
namespace {

using test::Network;

// Counts the multiplications and additions of the products of a network as Onednn runs it.
class Counter {
 public:
  struct Tensor {
    double rows = 0, columns = 0;
  };
  struct Index {
    double count = 0;
  };
  double flop = 0;

  Tensor tensor(std::span<const float>, int rows, int columns) { return {double(rows), double(columns)}; }
  Index index(std::span<const std::int32_t> numbers) { return {double(numbers.size())}; }
  Tensor linear(const nets::Path& path, const Tensor& x, int width) { return linear_of(path, {x}, width); }
  Tensor linear_of(const nets::Path&, const nets::Input<Counter>& input, int width) {
    double rows = input.front().rows ? input.front().rows->count : input.front().values.rows;
    for (const auto& part : input) flop += 2 * part.values.rows * part.values.columns * width;
    return {rows, double(width)};
  }
  Tensor edge_conv(const nets::Path&, const Tensor& x, const nets::Edges<Counter>& edges, int width) {
    flop += 2 * (x.rows * x.columns * 2 * width + edges.sources.count * width * width);
    return {x.rows, double(width)};
  }
  Tensor batch_norm(const nets::Path&, const Tensor& x) { return x; }
  Tensor relu(const Tensor& x) { return x; }
  Tensor subtract(const Tensor& x, const Tensor&) { return x; }
  Tensor concat(std::initializer_list<Tensor> parts) {
    Tensor out{parts.begin()->rows, 0};
    for (const Tensor& part : parts) out.columns += part.columns;
    return out;
  }
  Tensor rows(const Tensor& x, const Index& picked) { return {picked.count, x.columns}; }
  Tensor max_by(const Tensor& x, const Index& offsets) { return {offsets.count - 1, x.columns}; }
};

double flop_of(Network network, const NetworkInput& input) {
  Counter b;
  const auto mesh = nets::on_backend(b, input.mesh);
  const auto joints = nets::on_backend(b, *input.joints);
  switch (network) {
    case Network::joints:
      nets::rignet::joint_net(b, mesh);
      break;
    case Network::attention:
      nets::rignet::mask_net(b, mesh);
      break;
    case Network::votes:
      nets::vote_net(b, mesh, nets::on_backend(b, *input.votes));
      break;
    case Network::bones:
      nets::rignet::bone_net(b, mesh, joints, nets::on_backend(b, *input.pairs));
      break;
    case Network::root:
      nets::rignet::root_net(b, mesh, joints);
      break;
    case Network::skin:
      nets::rignet::skin_net(b, mesh, b.tensor(input.skin_features, input.mesh.batch.rows(), nets::rignet::skin_inputs));
      break;
    case Network::bind:
      nets::bind_net(b, mesh, nets::on_backend(b, *input.choices));
      break;
  }
  return b.flop;
}

// A tube of vertices, 40 around it, numbered ring by ring.
nets::MeshArrays tube(std::uint32_t vertices) {
  constexpr int around = 40;
  const int along = static_cast<int>(vertices) / around;
  auto neighbours = [&](std::span<const std::array<int, 2>> steps, nets::EdgeArrays& edges) {
    std::vector<std::uint32_t> offsets{0}, members;
    for (int y = 0; y < along; ++y) {
      for (int x = 0; x < around; ++x) {
        for (const auto& [dx, dy] : steps)
          members.push_back(static_cast<std::uint32_t>((y + dy + along) % along * around + (x + dx + around) % around));
        offsets.push_back(static_cast<std::uint32_t>(members.size()));
      }
    }
    edges.add(offsets, members, 0);
  };
  constexpr std::array<std::array<int, 2>, 6> six{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}}};
  constexpr std::array<std::array<int, 2>, 10> ten{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {2, 1}, {-2, -1}, {3, 0}, {-3, 0}, {1, 3}, {-1, -3}}};
  nets::MeshArrays out;
  neighbours(six, out.ring);
  neighbours(ten, out.geodesic);
  Random random(1);
  for (std::uint32_t i = 0; i < 3 * vertices; ++i) out.positions.push_back(random.uniform());
  out.batch.add(vertices);
  return out;
}

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// GFLOP/s of one core in a (1200,512) x (512,1024) product, about the networks' own size; weights packed, one thread.
double plain_product_rate() {
  using dnnl::memory;
  constexpr memory::dim m = 1200, k = 512, n = 1024;
  const dnnl::engine engine(dnnl::engine::kind::cpu, 0);
  dnnl::stream stream(engine);
  const memory::desc a({m, k}, memory::data_type::f32, memory::format_tag::ab), b({k, n}, memory::data_type::f32, memory::format_tag::any),
      c({m, n}, memory::data_type::f32, memory::format_tag::ab);
  const int threads_before = omp_get_max_threads();
  omp_set_num_threads(1);
  const dnnl::matmul::primitive_desc description({a, b, c}, engine);
  const dnnl::matmul product(description);
  memory x(a, engine), w(description.weights_desc(), engine), y(c, engine);
  std::fill_n(static_cast<float*>(x.get_data_handle()), m * k, 1.0f);
  std::fill_n(static_cast<float*>(w.get_data_handle()), w.get_desc().get_size() / sizeof(float), 1.0f);
  auto run = [&] {
    product.execute(stream, {{DNNL_ARG_SRC, x}, {DNNL_ARG_WEIGHTS, w}, {DNNL_ARG_DST, y}});
    stream.wait();
  };
  run();
  constexpr int repeats = 10;
  const double begin = processor_seconds();
  for (int i = 0; i < repeats; ++i) run();
  const double seconds = processor_seconds() - begin;
  omp_set_num_threads(threads_before);
  return repeats * 2e-9 * m * k * n / seconds;
}

void network(benchmark::State& state, Network which) {
  test::ExampleInput input = test::one_mesh(1, 25, 1);
  input.mesh = tube(static_cast<std::uint32_t>(state.range(0)));
  input.choices = test::one_mesh(static_cast<std::size_t>(state.range(0)), 1, 2).choices;
  input.votes = test::one_mesh(static_cast<std::size_t>(state.range(0)), 1, 2).votes;
  input.skin_features.assign(static_cast<std::size_t>(state.range(0)) * nets::rignet::skin_inputs, 0.5f);
  Onednn backend(test::random_parameters(which, 1));
  run(which, backend, input.view());  // packs the weights

  double of_product = 0, own = 0;
  const double flop = flop_of(which, input.view());
  for (auto _ : state) {
    const double begin = processor_seconds();
    benchmark::DoNotOptimize(run(which, backend, input.view()));
    own += processor_seconds() - begin;
    state.PauseTiming();
    of_product += plain_product_rate();
    state.ResumeTiming();
  }
  const auto rounds = static_cast<double>(state.iterations());
  const double rate = rounds * flop * 1e-9 / own;
  state.counters["GFLOP"] = flop * 1e-9;
  state.counters["GFLOP/s/core"] = rate;
  state.counters["product"] = of_product / rounds;
  state.counters["share"] = rate / (of_product / rounds);
}

void register_all() {
  for (const Network which : nets::rignet::kNetworks)
    benchmark::RegisterBenchmark(test::name_of({which, 0}).c_str(), network, which)
        ->Arg(1200)
        ->Arg(4000)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
}

const bool registered = (register_all(), true);

}  // namespace
}  // namespace osteon::infer
