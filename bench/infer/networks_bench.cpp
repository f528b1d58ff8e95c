// SPDX-License-Identifier: Apache-2.0
// Each network of RigNet on a regular mesh with 6 one-ring and 10 geodesic neighbours: wall time, GFLOP/s of one core (by the process's own
// processor time, so that other load on the machine counts little), and that rate as a share of a plain oneDNN product's in the same run.
#include <benchmark/benchmark.h>

#include "flop_counter.h"
#include "osteon/infer/onednn_backend.h"
#include "product_rate.h"
#include "regular_mesh.h"

namespace osteon::infer {
namespace {

using bench::flop_of;
using bench::plain_product_rate;
using bench::processor_seconds;
using test::Network;

void network(benchmark::State& state, Network which) {
  const test::ExampleInput input = bench::regular_input(static_cast<std::uint32_t>(state.range(0)));
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
