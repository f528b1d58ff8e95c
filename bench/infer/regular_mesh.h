// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "infer/examples.h"

// Inputs of the networks that are the same everywhere: no character is needed.
namespace osteon::bench {

// A tube of vertices, 40 around it, numbered ring by ring.
inline nets::MeshArrays tube(std::uint32_t vertices) {
  constexpr int around = 40;
  const int along = static_cast<int>(vertices) / around;
  auto neighbours = [&](std::span<const std::array<int, 2>> steps, nets::EdgeArrays& edges) {
    std::vector<std::uint32_t> offsets{0}, members;
    for (int y = 0; y < along; ++y) {
      for (int x = 0; x < around; ++x) {
        for (const auto& [dx, dy] : steps)
          members.push_back(static_cast<std::uint32_t>((y + dy + along) % along * around + (x + dx + around) % around));
        offsets.push_back(static_cast<std::uint32_t>(members.size()));
      }
    }
    edges.add(offsets, members, 0);
  };
  constexpr std::array<std::array<int, 2>, 6> six{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}}};
  constexpr std::array<std::array<int, 2>, 10> ten{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {2, 1}, {-2, -1}, {3, 0}, {-3, 0}, {1, 3}, {-1, -3}}};
  nets::MeshArrays out;
  neighbours(six, out.ring);
  neighbours(ten, out.geodesic);
  Random random(1);
  for (std::uint32_t i = 0; i < 3 * vertices; ++i) out.positions.push_back(random.uniform());
  out.batch.add(vertices);
  return out;
}

// What all networks read: that tube and 25 joints.
inline test::ExampleInput regular_input(std::uint32_t vertices) {
  test::ExampleInput input = test::one_mesh(1, 25, 1);
  const test::ExampleInput of_vertices = test::one_mesh(vertices, 1, 2);
  input.mesh = tube(vertices);
  input.choices = of_vertices.choices;
  input.votes = of_vertices.votes;
  input.neuro = of_vertices.neuro;
  input.skin_features.assign(vertices * nets::rignet::skin_inputs, 0.5f);
  return input;
}

}  // namespace osteon::bench
