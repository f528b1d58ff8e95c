// SPDX-License-Identifier: Apache-2.0
#include "osteon/mesh/triangle_mesh.h"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon {
namespace {

using testing::HasSubstr;
constexpr double kPi = std::numbers::pi;

// Volume by the divergence theorem: positive when a closed mesh faces outwards.
double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.faces) sum += static_cast<double>(mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c]))) / 6;
  return sum;
}

bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<VertexId, VertexId>, int> edges;
  for (const Triangle& t : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{t[k], t[(k + 1) % 3]}];
      --edges[{t[(k + 1) % 3], t[k]}];
    }
  return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
}

TEST(Shapes, are_closed_and_face_outwards) {
  EXPECT_NEAR(volume(shapes::box({1, 2, 3})), 6, 1e-5);
  EXPECT_NEAR(volume(shapes::icosphere(4)), 4 * kPi / 3, 0.02);
  EXPECT_NEAR(volume(shapes::capsule(1, 2, 64, 32)), 2 * kPi + 4 * kPi / 3, 0.06);
  for (const TriangleMesh& mesh : {shapes::box({1, 2, 3}), shapes::icosphere(2), shapes::capsule(0.1f, 1.0f)}) EXPECT_TRUE(is_closed(mesh));
  EXPECT_FALSE(is_closed(shapes::sheet(2, 2)));
}

TEST(Shapes, mirroring_keeps_faces_outward) {
  Transform mirror = Transform::Identity();
  mirror.linear()(0, 0) = -1;
  EXPECT_NEAR(volume(shapes::transformed(shapes::box({1, 1, 1}), mirror)), 1, 1e-6);
}

TEST(TriangleMesh, area_and_normals_of_a_sphere) {
  const TriangleMesh sphere = shapes::icosphere(4);
  EXPECT_NEAR(surface_area(sphere), 4 * kPi, 0.03);
  const auto normals = vertex_normals(sphere);
  for (VertexId v : sphere.positions.ids()) EXPECT_VEC3_NEAR(normals[v], sphere.positions[v], 0.02f);
}

TEST(TriangleMesh, normals_are_the_same_in_every_size) {
  const TriangleMesh sphere = shapes::icosphere(2);
  const auto normals = vertex_normals(sphere);
  for (const float size : {1e-14f, 1e-9f, 1e12f}) {
    TriangleMesh other = sphere;
    for (Vec3f& p : other.positions) p *= size;
    const auto of_other = vertex_normals(other);
    for (VertexId v : sphere.positions.ids()) EXPECT_VEC3_NEAR(of_other[v], normals[v], 1e-5f) << size;
  }
}

TEST(TriangleMesh, components_are_numbered_by_their_first_vertex) {
  const auto c = connected_components(shapes::merged(shapes::box({1, 1, 1}), shapes::icosphere(0)));
  EXPECT_EQ(c.count, 2u);
  EXPECT_EQ(c.of[VertexId{7}], 0u);
  EXPECT_EQ(c.of[VertexId{8}], 1u);
}

TEST(TriangleMesh, validate_names_the_culprit) {
  EXPECT_THAT(test::error_of([] { validate(TriangleMesh{}); }), HasSubstr("no vertices"));
  TriangleMesh mesh = shapes::box({1, 1, 1});
  mesh.faces.push_back({VertexId{0}, VertexId{1}, VertexId{8}});
  EXPECT_THAT(test::error_of([&] { validate(mesh); }), HasSubstr("face 12 uses vertex 8"));
  mesh.faces = {};
  mesh.positions[VertexId{3}].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(test::error_of([&] { validate(mesh); }), HasSubstr("vertex 3"));
}

}  // namespace
}  // namespace osteon
