// SPDX-License-Identifier: Apache-2.0
#include "infer/backend_cases.h"
#include "osteon/infer/loops_backend.h"
#include "osteon/infer/onednn_backend.h"
#include "support/expect.h"

namespace osteon::infer {
namespace {

static_assert(nets::Ops<Loops> && nets::Ops<Onednn>);

template <class B>
std::vector<std::pair<std::string, Matrix>> outputs() {
  const Shapes shapes = test::case_shapes();
  const Safetensors weights = test::random_weights(shapes, 31);
  return test::outputs_of_cases<B>([&](auto body) {
    B b(Parameters(weights, shapes, "seeded"));
    return b.matrix(body(b));
  });
}

TEST(Backends, onednn_equals_the_plain_loops_on_every_operation) { test::expect_near(outputs<Onednn>(), outputs<Loops>()); }

}  // namespace
}  // namespace osteon::infer
