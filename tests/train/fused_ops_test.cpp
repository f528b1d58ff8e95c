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

// Random signs of the normalisation's weights, so that the maximum turns into a minimum in some columns; random running means, so that
// renormalisation has something to correct.
Parameters shaken_parameters(Network network) {
  Parameters parameters = initial_parameters(nets::rignet::parameter_shapes(network), 5);
  for (auto& [name, value] : parameters) {
    if (name.find(".norm.weight") == std::string::npos && name.find(".norm.running_mean") == std::string::npos) continue;
    Random random(value.size(0));
    for (std::int64_t i = 0; i < value.size(0); ++i) value.data_ptr<float>()[i] = random.uniform(-1.0f, 1.0f);
  }
  prepare_for_training(parameters, at::kCPU);
  return parameters;
}

Result one_step(Network network, Engine engine, const NormRule& rule = {}) {
  Result result{{}, shaken_parameters(network)};
  RunOptions options;
  options.mode = Mode::training;
  options.engine = engine;
  options.norm = rule;
  result.output = run_network(network, result.parameters, test::two_characters(), options);
  Random random(3);
  at::Tensor direction = at::empty_like(result.output);
  for (std::int64_t i = 0; i < direction.numel(); ++i) direction.data_ptr<float>()[i] = random.normal();
  (result.output * direction).sum().backward();
  return result;
}

class FusedNetwork : public ::testing::TestWithParam<Network> {};

// A whole network makes a million decisions (ReLU, maximum); rounding turns a few of them, so gradients agree less closely than in one
// layer, and by how much depends on the processor. A wrong formula is off by as much as the gradient itself.
void expect_same_step(Network network, Engine engine, const NormRule& rule) {
  const Result plain = one_step(network, Engine::plain, rule), other_engine = one_step(network, engine, rule);
  EXPECT_LT(test::difference(other_engine.output, plain.output), 1e-4f);
  for (const auto& [name, value] : plain.parameters) {
    const at::Tensor& other = other_engine.parameters.at(name);
    if (is_trained(name))
      EXPECT_LT(test::difference(other.grad(), value.grad()), 1e-1f) << name;
    else
      EXPECT_LT(test::difference(other, value), 1e-4f) << name;
  }
}

TEST_P(FusedNetwork, gives_the_values_and_gradients_of_plain_operations) { expect_same_step(GetParam(), Engine::fused, {}); }

TEST_P(FusedNetwork, renormalises_like_plain_operations) { expect_same_step(GetParam(), Engine::fused, {0.05, 2.0, 1.0}); }

// What runs on a GPU computes on the CPU too.
TEST_P(FusedNetwork, is_the_same_as_for_a_device) {
  expect_same_step(GetParam(), Engine::device, {});
  expect_same_step(GetParam(), Engine::device, {0.05, 2.0, 1.0});
}

// Ioffe 2017: without bounds on the corrections, training sees exactly the values of use.
TEST_P(FusedNetwork, renormalised_without_bounds_gives_the_values_of_use) {
  Parameters parameters = shaken_parameters(GetParam());
  RunOptions use, training;
  training.mode = Mode::training;
  training.norm = {0.0, 1e9, 1e9};
  const at::NoGradGuard no_grad;
  const at::Tensor expected = run_network(GetParam(), parameters, test::two_characters(), use);
  EXPECT_LT(test::difference(run_network(GetParam(), parameters, test::two_characters(), training), expected), 1e-4f);
}

TEST_P(FusedNetwork, agrees_in_use) {
  Parameters parameters = shaken_parameters(GetParam());
  const auto output = [&](Engine engine) {
    const at::NoGradGuard no_grad;
    RunOptions options;
    options.engine = engine;
    return run_network(GetParam(), parameters, test::two_characters(), options);
  };
  EXPECT_LT(test::difference(output(Engine::fused), output(Engine::plain)), 1e-5f);
}

TEST_P(FusedNetwork, gives_the_same_bytes_with_one_and_two_threads) {
  at::set_num_threads(1);
  const Result one = one_step(GetParam(), Engine::fused);
  at::set_num_threads(2);
  const Result two = one_step(GetParam(), Engine::fused);
  EXPECT_TRUE(at::equal(one.output, two.output));
}

INSTANTIATE_TEST_SUITE_P(Rignet, FusedNetwork, ::testing::ValuesIn(nets::rignet::kNetworks));

}  // namespace
}  // namespace osteon::train
