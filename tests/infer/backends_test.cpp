// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include "examples.h"
#include "osteon/infer/loops_backend.h"
#include "osteon/infer/onednn_backend.h"
#include "support/expect.h"

namespace osteon::infer {
namespace {

using nets::Path;

static_assert(nets::Ops<Loops> && nets::Ops<Onednn>);

// A small network written over a backend: both run it on the same seeded parameters and inputs.
template <class B>
struct Stage {
  B b;
  Random random{21};

  typename B::Tensor values(std::size_t rows, std::size_t columns) {
    return b.tensor(test::random_floats(rows * columns, random), static_cast<int>(rows), static_cast<int>(columns));
  }
};

constexpr std::array<const char*, 4> norm_names{"weight", "bias", "running_mean", "running_var"};

void add_linear(Shapes& shapes, const std::string& name, std::int64_t outputs, std::int64_t inputs) {
  shapes[name + ".weight"] = {outputs, inputs};
  shapes[name + ".bias"] = {outputs};
}
void add_norm(Shapes& shapes, const std::string& name, std::int64_t width) {
  for (const char* part : norm_names) shapes[name + '.' + part] = {width};
}
void add_mlp(Shapes& shapes, const std::string& name, std::vector<std::int64_t> widths) {
  for (std::size_t i = 0; i + 1 < widths.size(); ++i) {
    add_linear(shapes, fmt::format("{}.{}.linear", name, i), widths[i + 1], widths[i]);
    add_norm(shapes, fmt::format("{}.{}.norm", name, i), widths[i + 1]);
  }
}

// Network is a generic lambda over Stage<B>& that gives a B::Tensor.
template <class Network>
void expect_equal_on_both(const Shapes& shapes, Network network) {
  const Safetensors weights = test::random_weights(shapes, 31);
  Stage<Loops> loops{Loops(Parameters(weights, shapes, "seeded"))};
  Stage<Onednn> onednn{Onednn(Parameters(weights, shapes, "seeded"))};
  const Matrix expected = loops.b.matrix(network(loops));
  EXPECT_LE(test::relative_difference(onednn.b.matrix(network(onednn)), expected), 1e-5f);
}

const std::vector<std::int32_t> picked{3, 3, 0, 6, 1, 5, 2, 0}, segments{0, 1, 5, 7};

TEST(Backends, each_operation_alone) {
  Shapes shapes;
  add_linear(shapes, "linear", 9, 5);
  add_norm(shapes, "norm", 5);
  expect_equal_on_both(shapes, [](auto& s) { return s.b.linear(Path("linear"), s.values(7, 5), 9); });
  expect_equal_on_both(shapes, [](auto& s) { return s.b.batch_norm(Path("norm"), s.values(7, 5)); });
  expect_equal_on_both(shapes, [](auto& s) { return s.b.relu(s.values(7, 5)); });
  expect_equal_on_both(shapes, [](auto& s) { return s.b.rows(s.values(7, 5), s.b.index(picked)); });
  expect_equal_on_both(shapes, [](auto& s) { return s.b.max_by(s.values(7, 5), s.b.index(segments)); });
  expect_equal_on_both(shapes, [](auto& s) {
    const auto x = s.values(7, 5), y = s.values(7, 5);
    return s.b.concat({x, y, s.b.subtract(x, y)});
  });
}

// What Onednn puts off must be done for every reader.
TEST(Backends, each_operation_on_a_normalised_value) {
  Shapes shapes;
  add_mlp(shapes, "mlp", {5, 8, 6});
  add_norm(shapes, "norm", 6);
  add_linear(shapes, "linear", 4, 6);
  auto on_mlp = [&](auto operation) {
    expect_equal_on_both(shapes, [&]<class B>(Stage<B>& s) {
      const auto input = s.values(7, 5);
      return operation(s, nets::mlp<B>(s.b, Path("mlp"), {input}, {8, 6}));
    });
  };
  on_mlp([](auto&, auto x) { return x; });
  on_mlp([](auto& s, auto x) { return s.b.linear(Path("linear"), x, 4); });
  on_mlp([](auto& s, auto x) { return s.b.batch_norm(Path("norm"), x); });
  on_mlp([](auto& s, auto x) { return s.b.relu(x); });
  on_mlp([](auto& s, auto x) { return s.b.rows(x, s.b.index(picked)); });
  on_mlp([](auto& s, auto x) { return s.b.max_by(x, s.b.index(segments)); });
  on_mlp([](auto& s, auto x) { return s.b.max_by(s.b.batch_norm(Path("norm"), x), s.b.index(segments)); });
  on_mlp([](auto& s, auto x) { return s.b.subtract(s.b.concat({x, s.b.relu(x)}), s.b.concat({s.b.relu(x), x})); });
}

TEST(Backends, an_edge_convolution_of_a_normalised_value) {
  Shapes shapes;
  add_mlp(shapes, "mlp", {5, 6});
  add_mlp(shapes, "conv", {12, 10, 10});
  add_linear(shapes, "out", 4, 16);
  const nets::MeshArrays mesh = test::one_mesh(80, 2, 4).mesh;
  expect_equal_on_both(shapes, [&]<class B>(Stage<B>& s) {
    const auto input = s.values(80, 5);
    const auto x = nets::mlp<B>(s.b, Path("mlp"), {input}, {6});
    const auto y = nets::edge_conv(s.b, Path("conv"), x, nets::on_backend(s.b, mesh.geodesic), 10);
    return nets::linear<B>(s.b, Path("out"), {x, y}, 4);
  });
}

TEST(Backends, an_mlp_of_own_and_picked_columns) {
  Shapes shapes;
  add_mlp(shapes, "picked", {4, 6});
  add_mlp(shapes, "mlp", {6 + 3, 20, 5});
  expect_equal_on_both(shapes, [&]<class B>(Stage<B>& s) {
    const auto few = s.values(7, 4), own = s.values(8, 3);
    const auto x = nets::mlp<B>(s.b, Path("picked"), {few}, {6});
    const auto index = s.b.index(picked);
    return nets::mlp<B>(s.b, Path("mlp"), {{x, index}, own}, {20, 5});
  });
}

}  // namespace
}  // namespace osteon::infer
