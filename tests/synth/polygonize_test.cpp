// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/polygonize.h"

#include <map>
#include <numbers>

#include "support/expect.h"

namespace osteon::synth {
namespace {

LocalField everywhere(Field field) {
  return [field](const Vec3f&, float) { return field; };
}

float ball(const Vec3f& p) { return p.norm() - 1.0f; }

TriangleMesh unit_ball(float cell) {
  return polygonize(everywhere(ball), Eigen::AlignedBox3f(Vec3f::Constant(-1), Vec3f::Constant(1)), cell);
}

// Directed edges that are not met by exactly one edge the other way.
std::size_t open_edges(const TriangleMesh& mesh) {
  std::map<std::pair<VertexId, VertexId>, int> count;
  for (const Triangle& face : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) ++count[{face[k], face[(k + 1) % 3]}];
  std::size_t open = 0;
  for (const auto& [edge, times] : count) {
    const auto back = count.find({edge.second, edge.first});
    open += times != 1 || back == count.end() || back->second != 1;
  }
  return open;
}

double volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.faces)
    sum += static_cast<double>(mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c]))) / 6.0;
  return sum;
}

TEST(Polygonize, sets_every_vertex_on_the_surface) {
  for (const Vec3f& p : unit_ball(0.1f).positions) EXPECT_NEAR(p.norm(), 1.0f, 1e-5f);
}

TEST(Polygonize, closes_the_surface_of_one_ball_and_faces_outwards) {
  const TriangleMesh mesh = unit_ball(0.1f);
  validate(mesh);
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_EQ(connected_components(mesh).count, 1u);
  EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * std::numbers::pi, 0.02);  // inscribed: the error is about cell^2
}

TEST(Polygonize, has_the_genus_of_a_torus) {
  const auto torus = [](const Vec3f& p) { return Eigen::Vector2f(Eigen::Vector2f(p.x(), p.z()).norm() - 1.0f, p.y()).norm() - 0.3f; };
  const TriangleMesh mesh = polygonize(everywhere(torus), Eigen::AlignedBox3f(Vec3f::Constant(-1.3f), Vec3f::Constant(1.3f)), 0.07f);
  EXPECT_EQ(open_edges(mesh), 0u);
  const auto euler = static_cast<long>(mesh.positions.size()) - static_cast<long>(mesh.faces.size()) / 2;  // V - E + F, E = 3F/2
  EXPECT_EQ(euler, 0);
}

TEST(Polygonize, mirrors_a_symmetric_shape) {
  const TriangleMesh mesh = unit_ball(0.13f);
  for (const Vec3f& p : mesh.positions) {
    float nearest = 1.0f;
    for (const Vec3f& q : mesh.positions) nearest = std::min(nearest, (Vec3f(-p.x(), p.y(), p.z()) - q).norm());
    EXPECT_LT(nearest, 1e-5f);
  }
}

}  // namespace
}  // namespace osteon::synth
