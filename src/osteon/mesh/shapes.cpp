// SPDX-License-Identifier: Apache-2.0
#include "osteon/mesh/shapes.h"

#include <cmath>
#include <map>
#include <numbers>

namespace osteon::shapes {
namespace {

VertexId vertex(std::size_t i) { return static_cast<VertexId>(i); }

void add_face(TriangleMesh& mesh, std::size_t a, std::size_t b, std::size_t c) { mesh.faces.push_back({vertex(a), vertex(b), vertex(c)}); }

}  // namespace

TriangleMesh box(const Vec3f& size) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)  // bit 0: x, bit 1: y, bit 2: z
    mesh.positions.push_back(Vec3f(i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f).cwiseProduct(size));
  constexpr std::size_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    add_face(mesh, q[0], q[1], q[2]);
    add_face(mesh, q[0], q[2], q[3]);
  }
  return mesh;
}

TriangleMesh icosphere(int subdivisions, float radius) {
  const float t = std::numbers::phi_v<float>;
  TriangleMesh mesh;
  for (const Vec3f& p : {Vec3f(-1, t, 0), Vec3f(1, t, 0), Vec3f(-1, -t, 0), Vec3f(1, -t, 0), Vec3f(0, -1, t), Vec3f(0, 1, t),
                         Vec3f(0, -1, -t), Vec3f(0, 1, -t), Vec3f(t, 0, -1), Vec3f(t, 0, 1), Vec3f(-t, 0, -1), Vec3f(-t, 0, 1)})
    mesh.positions.push_back(p.normalized());
  constexpr std::size_t faces[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (const auto& f : faces) add_face(mesh, f[0], f[1], f[2]);
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<VertexId, VertexId>, VertexId> middles;
    const auto middle = [&](VertexId a, VertexId b) {
      const auto [entry, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)});
      if (is_new) entry->second = mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]).normalized());
      return entry->second;
    };
    PerFace<Triangle> finer;
    for (const auto& [a, b, c] : mesh.faces) {
      const VertexId ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& t4 : {Triangle{a, ab, ca}, Triangle{b, bc, ab}, Triangle{c, ca, bc}, Triangle{ab, bc, ca}}) finer.push_back(t4);
    }
    mesh.faces = std::move(finer);
  }
  for (Vec3f& p : mesh.positions) p *= radius;
  return mesh;
}

TriangleMesh capsule(float radius, float length, int segments, int rings) {
  TriangleMesh mesh;
  const int half = rings / 2 + 1;                // rings of each cap, its rim included
  std::vector<std::pair<float, float>> profile;  // (radius, height) from the bottom to the top, poles apart
  for (int k = 1; k <= half; ++k) {
    const float angle = std::numbers::pi_v<float> / 2 * static_cast<float>(k) / static_cast<float>(half);
    profile.emplace_back(radius * std::sin(angle), -radius * std::cos(angle));
  }
  const int body =
      std::max(1, static_cast<int>(std::lround(length / (2 * std::numbers::pi_v<float> * radius / static_cast<float>(segments)))));
  for (int k = 1; k < body; ++k) profile.emplace_back(radius, length * static_cast<float>(k) / static_cast<float>(body));
  for (int k = half; k >= 1; --k) {
    const auto [r, y] = profile[static_cast<std::size_t>(k - 1)];
    profile.emplace_back(r, length - y);
  }
  const std::size_t bottom = index(mesh.positions.push_back(Vec3f(0, -radius, 0)));
  const auto ring_vertex = [&](std::size_t ring, int s) {
    return 1 + ring * static_cast<std::size_t>(segments) + static_cast<std::size_t>(s % segments);
  };
  for (const auto& [r, y] : profile)
    for (int s = 0; s < segments; ++s) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(s) / static_cast<float>(segments);
      mesh.positions.push_back(Vec3f(r * std::cos(angle), y, r * std::sin(angle)));
    }
  const std::size_t top = index(mesh.positions.push_back(Vec3f(0, length + radius, 0)));
  for (int s = 0; s < segments; ++s) {
    add_face(mesh, bottom, ring_vertex(0, s), ring_vertex(0, s + 1));
    for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
      add_face(mesh, ring_vertex(ring, s), ring_vertex(ring + 1, s), ring_vertex(ring, s + 1));
      add_face(mesh, ring_vertex(ring, s + 1), ring_vertex(ring + 1, s), ring_vertex(ring + 1, s + 1));
    }
    add_face(mesh, top, ring_vertex(profile.size() - 1, s + 1), ring_vertex(profile.size() - 1, s));
  }
  return mesh;
}

TriangleMesh sheet(int columns, int rows) {
  TriangleMesh mesh;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c)
      mesh.positions.push_back(
          Vec3f(static_cast<float>(c) / static_cast<float>(columns), static_cast<float>(r) / static_cast<float>(rows), 0));
  const auto at = [&](int r, int c) { return static_cast<std::size_t>(r * (columns + 1) + c); };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      add_face(mesh, at(r, c), at(r, c + 1), at(r + 1, c + 1));
      add_face(mesh, at(r, c), at(r + 1, c + 1), at(r + 1, c));
    }
  return mesh;
}

TriangleMesh merged(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh mesh = a;
  for (const Vec3f& p : b.positions) mesh.positions.push_back(p);
  const std::size_t shift = a.positions.size();
  for (const auto& [x, y, z] : b.faces) add_face(mesh, index(x) + shift, index(y) + shift, index(z) + shift);
  return mesh;
}

TriangleMesh transformed(TriangleMesh mesh, const Transform& transform) {
  for (Vec3f& p : mesh.positions) p = transform * p;
  if (transform.linear().determinant() < 0)
    for (Triangle& t : mesh.faces) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh shifted(TriangleMesh mesh, const Vec3f& by) { return transformed(std::move(mesh), Transform(Eigen::Translation3f(by))); }

}  // namespace osteon::shapes
