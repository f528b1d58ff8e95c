// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "infer/examples.h"

// One list of small computations over a backend (nets/ops.h) on seeded weights and inputs: each operation alone and on what a backend may
// have put off or merged. All backends must agree on all of them.
namespace osteon::test {

using nets::Path;

// Where a case computes: the backend, and inputs that are the same for every backend.
template <class B>
struct Stage {
  B& b;
  Random random{21};

  typename B::Tensor values(std::size_t rows, std::size_t columns) {
    return b.tensor(random_floats(rows * columns, random), static_cast<int>(rows), static_cast<int>(columns));
  }
};

inline void add_linear(infer::Shapes& shapes, const std::string& name, std::int64_t outputs, std::int64_t inputs) {
  shapes[name + ".weight"] = {outputs, inputs};
  shapes[name + ".bias"] = {outputs};
}
inline void add_norm(infer::Shapes& shapes, const std::string& name, std::int64_t width) {
  for (const char* part : {".weight", ".bias", ".running_mean", ".running_var"}) shapes[name + part] = {width};
}
inline void add_mlp(infer::Shapes& shapes, const std::string& name, const std::vector<std::int64_t>& widths) {
  for (std::size_t i = 0; i + 1 < widths.size(); ++i) {
    add_linear(shapes, fmt::format("{}.{}.linear", name, i), widths[i + 1], widths[i]);
    add_norm(shapes, fmt::format("{}.{}.norm", name, i), widths[i + 1]);
  }
}

// Parameters that the cases use between them.
inline infer::Shapes case_shapes() {
  infer::Shapes shapes;
  add_linear(shapes, "linear", 9, 6);
  add_norm(shapes, "norm", 6);
  add_mlp(shapes, "mlp", {5, 8, 6});
  add_mlp(shapes, "conv", {12, 10, 10});
  add_mlp(shapes, "picked", {6 + 3, 20, 5});
  add_linear(shapes, "out", 4, 16);
  add_norm(shapes, "heard", 16);
  return shapes;
}

// The outputs of all cases by name. `run(body)` makes a fresh backend b of type B with random_weights(case_shapes(), ...) and gives the
// Matrix of the B::Tensor body(b).
template <class B, class Run>
std::vector<std::pair<std::string, Matrix>> outputs_of_cases(Run&& run) {
  std::vector<std::pair<std::string, Matrix>> out;
  auto add = [&](const char* name, auto computation) {
    out.emplace_back(name, run([&](B& b) {
                       Stage<B> stage{b};
                       return computation(stage);
                     }));
  };
  const std::vector<std::int32_t> picked{3, 3, 0, 6, 1, 5, 2, 0}, segments{0, 1, 5, 7};
  const nets::MeshArrays mesh = one_mesh(80, 2, 4).mesh;
  using S = Stage<B>;

  add("linear", [&](S& s) { return s.b.linear(Path("linear"), s.values(7, 6), 9); });
  add("batch_norm", [&](S& s) { return s.b.batch_norm(Path("norm"), s.values(7, 6)); });
  add("relu", [&](S& s) { return s.b.relu(s.values(7, 5)); });
  add("rows", [&](S& s) { return s.b.rows(s.values(7, 5), s.b.index(picked)); });
  add("max_by", [&](S& s) { return s.b.max_by(s.values(7, 5), s.b.index(segments)); });
  add("subtract and concat", [&](S& s) {
    const auto x = s.values(7, 5), y = s.values(7, 5), difference = s.b.subtract(x, y);
    return s.b.concat({x, y, difference});
  });

  auto mlp = [](S& s) { return nets::mlp<B>(s.b, Path("mlp"), {s.values(7, 5)}, {8, 6}); };  // ends with a normalisation
  add("mlp", mlp);
  add("linear of mlp", [&](S& s) { return s.b.linear(Path("linear"), mlp(s), 9); });
  add("batch_norm of mlp", [&](S& s) { return s.b.batch_norm(Path("norm"), mlp(s)); });
  add("relu of mlp", [&](S& s) { return s.b.relu(mlp(s)); });
  add("rows of mlp", [&](S& s) { return s.b.rows(mlp(s), s.b.index(picked)); });
  add("max_by of mlp", [&](S& s) { return s.b.max_by(mlp(s), s.b.index(segments)); });
  add("max_by of batch_norm of mlp", [&](S& s) { return s.b.max_by(s.b.batch_norm(Path("norm"), mlp(s)), s.b.index(segments)); });
  add("concat of mlp", [&](S& s) {
    const auto x = mlp(s), positive = s.b.relu(x);
    return s.b.concat({x, positive});
  });

  auto conv = [&](S& s, const auto& x) { return nets::edge_conv(s.b, Path("conv"), x, nets::on_backend(s.b, mesh.geodesic), 10); };
  auto wide_mlp = [](S& s) { return nets::mlp<B>(s.b, Path("mlp"), {s.values(80, 5)}, {8, 6}); };
  add("edge_conv", [&](S& s) { return conv(s, s.values(80, 6)); });
  add("edge_conv of mlp", [&](S& s) { return conv(s, wide_mlp(s)); });
  add("linear of mlp and its edge_conv", [&](S& s) {
    const auto x = wide_mlp(s), y = conv(s, x);
    return nets::linear<B>(s.b, Path("out"), {x, y}, 4);
  });
  add("mlp of own and picked columns", [&](S& s) {
    const auto x = mlp(s), own = s.values(8, 3);
    const auto index = s.b.index(picked);
    return nets::mlp<B>(s.b, Path("picked"), {{x, index}, own}, {20, 5});
  });
  add("mean_of", [&](S& s) { return s.b.mean_of(s.values(80, 6), s.b.index(mesh.geodesic.offsets), s.b.index(mesh.geodesic.sources)); });
  add("mean_of mlp", [&](S& s) { return s.b.mean_of(wide_mlp(s), s.b.index(mesh.geodesic.offsets), s.b.index(mesh.geodesic.sources)); });
  add("attend", [&](S& s) { return s.b.attend(s.values(80, 32), s.b.index(mesh.ring.offsets), s.b.index(mesh.ring.sources), 2); });
  add("linear of relu_norm of attend", [&](S& s) {
    const auto heard = s.b.attend(s.values(80, 16), s.b.index(mesh.ring.offsets), s.b.index(mesh.ring.sources), 1);
    return nets::linear<B>(s.b, Path("out"), {nets::relu_norm(s.b, Path("heard"), heard)}, 4);
  });
  return out;
}

inline void expect_near(const std::vector<std::pair<std::string, Matrix>>& a, const std::vector<std::pair<std::string, Matrix>>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LE(relative_difference(a[i].second, b[i].second), 1e-5f) << a[i].first;
}

}  // namespace osteon::test
