// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"

namespace osteon::test {

inline TriangleMesh flipped(TriangleMesh mesh) {
  for (Triangle& t : mesh.faces) std::swap(t[1], t[2]);
  return mesh;
}

// Each face with three vertices of its own, as in STL files.
inline TriangleMesh unshared(const TriangleMesh& mesh) {
  TriangleMesh out;
  for (Triangle t : mesh.faces) {
    for (VertexId& v : t) v = out.positions.push_back(mesh.positions[v]);
    out.faces.push_back(t);
  }
  return out;
}

// The same mesh with vertices and faces in another order, and the corners of each face rotated.
inline TriangleMesh shuffled(const TriangleMesh& mesh, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint32_t> place(mesh.positions.size());
  std::iota(place.begin(), place.end(), 0u);
  random.shuffle(std::span(place));
  TriangleMesh out;
  out.positions.resize(mesh.positions.size());
  for (VertexId v : mesh.positions.ids()) out.positions[VertexId{place[index(v)]}] = mesh.positions[v];
  for (const Triangle& t : mesh.faces) {
    const std::size_t first = random.below(3);
    Triangle s;
    for (std::size_t k = 0; k < 3; ++k) s[k] = VertexId{place[index(t[(first + k) % 3])]};
    out.faces.push_back(s);
  }
  random.shuffle(std::span(out.faces.raw()));
  return out;
}

// A strip of quads closed with half a twist: one side, one border.
inline TriangleMesh moebius_strip(int quads) {
  TriangleMesh mesh;
  for (int i = 0; i < quads; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(quads);
    for (float side : {-0.3f, 0.3f}) {
      const float radius = 1 + side * std::cos(angle / 2);
      mesh.positions.push_back(Vec3f(radius * std::cos(angle), side * std::sin(angle / 2), radius * std::sin(angle)));
    }
  }
  for (int i = 0; i < quads; ++i) {
    const bool last = i + 1 == quads;
    const auto at = [](int v) { return static_cast<VertexId>(v); };
    const VertexId a = at(2 * i), b = at(2 * i + 1), c = at(last ? 1 : 2 * i + 2), d = at(last ? 0 : 2 * i + 3);
    mesh.faces.push_back({a, b, d});
    mesh.faces.push_back({a, d, c});
  }
  return mesh;
}

// Three sheets that meet in one edge line: every edge on it has three faces.
inline TriangleMesh three_pages(int cells) {
  TriangleMesh mesh = shapes::sheet(cells, cells);
  const TriangleMesh page = mesh;
  for (float angle : {2.0f, 4.0f}) {
    const Transform turn(Eigen::AngleAxisf(angle, Vec3f::UnitY()));
    std::vector<VertexId> of(page.positions.size());
    for (VertexId v : page.positions.ids())
      of[index(v)] = page.positions[v].x() == 0 ? v : mesh.positions.push_back(turn * page.positions[v]);
    for (const Triangle& t : page.faces) mesh.faces.push_back({of[index(t[0])], of[index(t[1])], of[index(t[2])]});
  }
  return mesh;
}

// What modellers' files hold, and what an algorithm that expects clean two-manifolds stumbles over.
inline std::vector<std::pair<std::string, TriangleMesh>> awkward_meshes() {
  TriangleMesh messy = shapes::icosphere(2);
  Random random(7);
  const std::size_t n = messy.positions.size(), faces = messy.faces.size();
  for (int i = 0; i < 20; ++i) messy.faces.push_back(messy.faces.raw()[random.below(faces)]);  // copies
  for (int i = 0; i < 20; ++i) {                                                               // fins through the inside
    Triangle t;
    for (VertexId& v : t) v = static_cast<VertexId>(random.below(n));
    messy.faces.push_back(t);
  }
  messy.positions.push_back(Vec3f(5, 5, 5));  // used by no face
  const TriangleMesh box = shapes::box({1, 1, 1}), sheet = shapes::sheet(6, 5);
  TriangleMesh pieces;
  for (int i = 0; i < 40; ++i)
    pieces = shapes::merged(pieces, shapes::shifted(shapes::icosphere(0, 0.02f), Vec3f(random.uniform(), random.uniform(), 0)));
  return {{"sphere of separate faces", unshared(shapes::icosphere(3))},
          {"moebius strip", moebius_strip(24)},
          {"three pages", three_pages(6)},
          {"two stacked boxes", shapes::merged(box, shapes::shifted(box, {0, 1, 0}))},
          {"two stacked boxes of separate faces", unshared(shapes::merged(box, shapes::shifted(box, {0, 1, 0})))},
          {"sheet from both sides", shapes::merged(sheet, flipped(sheet))},
          {"sphere twice", shapes::merged(shapes::icosphere(2), shapes::icosphere(2))},
          {"sphere and its reverse", shapes::merged(shapes::icosphere(2), flipped(shapes::icosphere(2)))},
          {"spheres that touch in a point", shapes::merged(shapes::icosphere(2), shapes::shifted(shapes::icosphere(2), {0, 2, 0}))},
          {"sphere with fins, copies and a stray vertex", messy},
          {"many pieces", pieces}};
}

}  // namespace osteon::test
