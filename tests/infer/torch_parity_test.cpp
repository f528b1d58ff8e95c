// SPDX-License-Identifier: Apache-2.0
#include "infer/backend_cases.h"
#include "osteon/infer/loops_backend.h"
#include "osteon/infer/onednn_backend.h"
#include "osteon/train/torch_ops.h"
#include "support/expect.h"

// What is trained is what runs: the trainer's backends and the product's give the same numbers for the same weights.
namespace osteon {
namespace {

using test::Network;

Matrix matrix_of(const at::Tensor& t) {
  const at::Tensor dense = t.detach().contiguous();
  return Eigen::Map<const Matrix>(dense.data_ptr<float>(), dense.size(0), dense.size(1));
}

train::Parameters on_torch(const Safetensors& weights) {
  train::Parameters out;
  for (const auto& [name, array] : weights.arrays) {
    std::vector<float> values = array.values<float>();
    out.emplace(name, torch::from_blob(values.data(), array.shape, torch::kFloat).clone());
  }
  return out;
}

TEST(TorchParity, every_operation) {
  const infer::Shapes shapes = test::case_shapes();
  const Safetensors weights = test::random_weights(shapes, 31);
  const auto by_torch = test::outputs_of_cases<train::TorchOps>([&](auto body) {
    train::Parameters parameters = on_torch(weights);
    train::TorchOps b(parameters, train::Mode::use, at::kCPU);
    return matrix_of(body(b));
  });
  const auto by_onednn = test::outputs_of_cases<infer::Onednn>([&](auto body) {
    infer::Onednn b(infer::Parameters(weights, shapes, "seeded"));
    return b.matrix(body(b));
  });
  test::expect_near(by_onednn, by_torch);
}

class TorchNetworks : public testing::TestWithParam<Network> {};
INSTANTIATE_TEST_SUITE_P(rignet, TorchNetworks, testing::ValuesIn(nets::rignet::kNetworks), test::name_of);

TEST_P(TorchNetworks, both_engines_of_the_trainer_equal_the_product) {
  Random random(41);
  test::ExampleInput input;
  input.add_mesh(70, 6, random);
  input.add_mesh(90, 3, random);
  const Safetensors weights = test::random_weights(nets::rignet::parameter_shapes(GetParam()), 42);
  infer::Onednn onednn(infer::Parameters(weights, nets::rignet::parameter_shapes(GetParam()), "seeded"));
  const Matrix product = infer::run(GetParam(), onednn, input.view());
  // A softmax of dot products that nobody scales multiplies rounding by the size of its scores.
  const bool attends = GetParam() == Network::neuroskinning || GetParam() == Network::neuroskinning_2019;
  const float tolerance = attends ? 5e-5f : 1e-5f;
  for (const train::Engine engine : {train::Engine::plain, train::Engine::fused}) {
    train::Parameters parameters = on_torch(weights);
    const Matrix trained = matrix_of(train::run_network(GetParam(), parameters, input, {train::Mode::use, engine}));
    EXPECT_LE(test::relative_difference(product, trained), tolerance) << (engine == train::Engine::plain ? "plain" : "fused");
  }
}

}  // namespace
}  // namespace osteon
