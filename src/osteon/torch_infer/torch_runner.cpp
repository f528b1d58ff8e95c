// SPDX-License-Identifier: Apache-2.0
#include "osteon/torch_infer/torch_runner.h"

#include <ATen/core/grad_mode.h>

#include <utility>

#include "osteon/base/error.h"
#include "osteon/train/model.h"
#include "osteon/train/networks.h"

namespace osteon::torch_infer {
namespace {

using nets::rignet::Network;

at::Device device_named(const std::string& name) {
  try {
    const at::Device device(name);
    at::zeros({1}, at::TensorOptions(device));  // fails where there is none
    return device;
  } catch (const std::exception&) {
    throw Error("device {}: LibTorch has none of that name, expected cpu, or cuda on a machine with a GPU", name);
  }
}

nets::NetworkInputs copied(const infer::NetworkInput& input) {
  nets::NetworkInputs out;
  out.mesh = input.mesh;
  if (input.joints) out.joints = *input.joints;
  if (input.pairs) out.pairs = *input.pairs;
  out.skin_features.assign(input.skin_features.begin(), input.skin_features.end());
  if (input.choices) out.choices = *input.choices;
  if (input.votes) out.votes = *input.votes;
  if (input.tree) out.tree = *input.tree;
  if (input.neuro) out.neuro = *input.neuro;
  return out;
}

class TorchRunner : public infer::NetworkRunner {
 public:
  TorchRunner(Network network, const std::filesystem::path& weights, at::Device device)
      : network_(network), parameters_(train::load_weights(weights, network)), device_(device) {
    const at::NoGradGuard no_grad;
    for (auto& [name, value] : parameters_) value = value.detach().to(device_);
  }

  Matrix run(const infer::NetworkInput& input) const override {
    const at::NoGradGuard no_grad;
    const train::RunOptions options{.mode = train::Mode::use, .engine = train::Engine::device, .device = device_};
    const at::Tensor out = train::run_network(network_, parameters_, copied(input), options).to(at::kCPU).contiguous();
    return Eigen::Map<const Matrix>(out.data_ptr<float>(), out.size(0), out.size(1));
  }

 private:
  Network network_;
  mutable train::Parameters parameters_;  // only read in use
  at::Device device_;
};

}  // namespace

infer::RunnerFactory torch_runners(const std::string& device) {
  return [on = device_named(device)](Network network, const std::filesystem::path& weights) {
    return std::make_unique<TorchRunner>(network, weights, on);
  };
}

}  // namespace osteon::torch_infer
