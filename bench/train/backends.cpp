// SPDX-License-Identifier: Apache-2.0
// backends MODELS [VERTICES]: the networks in the folders MODELS/rignet, rignet-2020 and neuroskinning by oneDNN, as they are used, and by
// plain LibTorch operations, in turns in one process on all cores: median time of each, how many times faster ours is, and the largest
// difference of the outputs in parts of the largest value.
#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "infer/regular_mesh.h"
#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/infer/onednn_backend.h"
#include "osteon/train/model.h"
#include "osteon/train/networks.h"

namespace osteon {
namespace {

namespace fs = std::filesystem;
using nets::rignet::Network;

constexpr int kRounds = 9;

template <class Work>
double milliseconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

float difference(const at::Tensor& torch, const Matrix& ours) {
  const at::Tensor values = torch.contiguous();
  const Eigen::Map<const Matrix> theirs(values.data_ptr<float>(), ours.rows(), ours.cols());
  return (theirs - ours).cwiseAbs().maxCoeff() / std::max(theirs.cwiseAbs().maxCoeff(), 1e-6f);
}

void compare(Network network, const fs::path& file, const test::ExampleInput& input) {
  infer::Onednn onednn(infer::load_parameters(file, nets::rignet::parameter_shapes(network)));
  train::Parameters parameters = train::load_weights(file, network);
  const train::RunOptions plain{.mode = train::Mode::use, .engine = train::Engine::plain};
  Matrix ours;
  at::Tensor theirs;
  const auto by_onednn = [&] { ours = infer::run(network, onednn, input.view()); };
  const auto by_torch = [&] { theirs = train::run_network(network, parameters, input, plain); };
  by_onednn();  // packs the weights
  by_torch();
  std::vector<double> own, torch;
  for (int round = 0; round < kRounds; ++round) {
    own.push_back(milliseconds_of(by_onednn));
    torch.push_back(milliseconds_of(by_torch));
  }
  fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.0e} |\n", nets::rignet::name_of(network), median(own), median(torch),
             median(torch) / median(own), difference(theirs, ours));
  std::fflush(stdout);
}

void run(const fs::path& models, std::uint32_t vertices) {
  const at::NoGradGuard no_grad;
  at::set_num_threads(threads());
  const test::ExampleInput input = bench::regular_input(vertices);
  fmt::print("| {} vertices, {} threads | Osteon, ms | LibTorch, ms | times faster | difference |\n|---|---|---|---|---|\n", vertices,
             threads());
  for (const Network network : nets::rignet::kNetworks)
    for (const char* folder : {"rignet", "rignet-2020", "neuroskinning"})
      if (const fs::path file = models / folder / fmt::format("{}.safetensors", nets::rignet::name_of(network)); fs::exists(file)) {
        compare(network, file, input);
        break;
      }
}

}  // namespace
}  // namespace osteon

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: backends MODELS [VERTICES]\n");
    return 2;
  }
  try {
    osteon::run(argv[1], argc > 2 ? static_cast<std::uint32_t>(std::stoul(argv[2])) : 1200);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}
