// SPDX-License-Identifier: Apache-2.0
#include <ATen/Parallel.h>
#include <gtest/gtest.h>
#include <torch/types.h>

#include <string>

#include "osteon/nets/dry_run.h"
#include "osteon/train/networks.h"
#include "synthetic.h"

namespace osteon::train {
namespace {

using nets::rignet::Network;

struct Result {
  at::Tensor output;
  Parameters parameters;  // after the step: with gradients, and with new running figures
};

// Random signs of the normalisation's weights, so that the maximum turns into a minimum in some columns.
Parameters shaken_parameters(Network network) {
  Parameters parameters = initial_parameters(nets::rignet::parameter_shapes(network), 5);
  for (auto& [name, value] : parameters) {
    if (name.find(".norm.weight") == std::string::npos) continue;
    Random random(value.size(0));
    for (std::int64_t i = 0; i < value.size(0); ++i) value.data_ptr<float>()[i] = random.uniform(-1.0f, 1.0f);
  }
  prepare_for_training(parameters, at::kCPU);
  return parameters;
}

Result one_step(Network network, Engine engine) {
  Result result{{}, shaken_parameters(network)};
  RunOptions options;
  options.mode = Mode::training;
  options.engine = engine;
  result.output = run_network(network, result.parameters, test::two_characters(), options);
  Random random(3);
  at::Tensor direction = at::empty_like(result.output);
  for (std::int64_t i = 0; i < direction.numel(); ++i) direction.data_ptr<float>()[i] = random.normal();
  (result.output * direction).sum().backward();
  return result;
}

float difference(const at::Tensor& a, const at::Tensor& b) { return ((a - b).norm() / (b.norm() + 1e-6f)).item<float>(); }

class FusedNetwork : public ::testing::TestWithParam<Network> {};

// A whole network makes a million decisions (ReLU, maximum); rounding turns a few of them, so gradients agree less closely than in one
// layer.
TEST_P(FusedNetwork, gives_the_values_and_gradients_of_plain_operations) {
  const Result plain = one_step(GetParam(), Engine::plain), fused = one_step(GetParam(), Engine::fused);
  EXPECT_LT(difference(fused.output, plain.output), 1e-4f);
  for (const auto& [name, value] : plain.parameters) {
    const at::Tensor& other = fused.parameters.at(name);
    if (is_trained(name))
      EXPECT_LT(difference(other.grad(), value.grad()), 2e-2f) << name;
    else
      EXPECT_LT(difference(other, value), 1e-4f) << name;
  }
}

TEST_P(FusedNetwork, agrees_in_use) {
  Parameters parameters = shaken_parameters(GetParam());
  const auto output = [&](Engine engine) {
    const at::NoGradGuard no_grad;
    RunOptions options;
    options.engine = engine;
    return run_network(GetParam(), parameters, test::two_characters(), options);
  };
  EXPECT_LT(difference(output(Engine::fused), output(Engine::plain)), 1e-5f);
}

TEST_P(FusedNetwork, gives_the_same_bytes_with_one_and_two_threads) {
  at::set_num_threads(1);
  const Result one = one_step(GetParam(), Engine::fused);
  at::set_num_threads(2);
  const Result two = one_step(GetParam(), Engine::fused);
  EXPECT_TRUE(at::equal(one.output, two.output));
}

INSTANTIATE_TEST_SUITE_P(Rignet, FusedNetwork,
                         ::testing::Values(Network::joints, Network::attention, Network::bones, Network::root, Network::skin));

}  // namespace
}  // namespace osteon::train
