// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <omp.h>
#include <time.h>

#include <algorithm>
#include <oneapi/dnnl/dnnl.hpp>

// What the networks are measured against.
namespace osteon::bench {

inline double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// GFLOP/s of one core in a (1200,512) x (512,1024) product, about the networks' own size; weights packed, one thread.
inline double plain_product_rate() {
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

}  // namespace osteon::bench
