// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/corner_normals.h"

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::render {
namespace {

TEST(CornerNormals, a_sphere_is_smooth) {
  const TriangleMesh sphere = shapes::icosphere(3);
  const auto normals = corner_normals(sphere);
  for (const FaceId f : sphere.faces.ids())
    for (std::size_t i = 0; i < 3; ++i) EXPECT_VEC3_NEAR(normals[f][i], sphere.positions[sphere.faces[f][i]], 0.02f);
}

TEST(CornerNormals, a_box_keeps_its_edges) {
  const TriangleMesh box = shapes::box({1, 2, 3});
  const auto normals = corner_normals(box);
  for (const FaceId f : box.faces.ids())
    for (const Vec3f& n : normals[f]) EXPECT_VEC3_NEAR(n, area_vector(box, f).normalized(), 1e-6f);
}

// The same sphere with three vertices of its own for each face.
TEST(CornerNormals, seams_do_not_show) {
  const TriangleMesh sphere = shapes::icosphere(2);
  TriangleMesh apart;
  for (const Triangle& t : sphere.faces) {
    Triangle own;
    for (std::size_t i = 0; i < 3; ++i) own[i] = apart.positions.push_back(sphere.positions[t[i]]);
    apart.faces.push_back(own);
  }
  const auto expected = corner_normals(sphere), found = corner_normals(apart);
  for (const FaceId f : sphere.faces.ids())
    for (std::size_t i = 0; i < 3; ++i) EXPECT_VEC3_NEAR(found[f][i], expected[f][i], 1e-5f);
}

TEST(CornerNormals, a_face_without_area_has_one_all_the_same) {
  TriangleMesh mesh;
  const VertexId a = mesh.positions.push_back({0, 0, 0}), b = mesh.positions.push_back({1, 0, 0});
  mesh.faces.push_back({a, b, b});
  const auto normals = corner_normals(mesh);
  for (const Vec3f& n : normals[FaceId{0}]) EXPECT_VEC3_NEAR(n, Vec3f::UnitZ(), 0);
}

}  // namespace
}  // namespace osteon::render
