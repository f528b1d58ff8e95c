// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/orientation.h"

#include "geometry/mesh_makers.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

using shapes::shifted;

TEST(Orientation, a_body_inside_out_is_turned_with_its_parts_and_one_that_stands_right_is_not) {
  const TriangleMesh right = shapes::merged(shapes::icosphere(3, 1.0f), shifted(shapes::box({0.2f, 0.2f, 0.2f}), {0, 0, 1.2f}));
  TriangleMesh mesh = right;
  EXPECT_EQ(turn_inside_out(mesh), 0u);
  EXPECT_EQ(mesh.faces, right.faces);
  mesh = test::flipped(right);
  EXPECT_EQ(turn_inside_out(mesh), right.faces.size());
  EXPECT_EQ(mesh.faces, right.faces);
}

TEST(Orientation, faces_that_look_the_other_way_than_most_beside_them_are_turned) {
  const TriangleMesh right = shapes::merged(shapes::icosphere(3), shifted(shapes::sheet(9, 9), {3, 0, 0}));
  TriangleMesh mesh = right;
  std::size_t turned = 0;
  for (FaceId f : mesh.faces.ids())
    if (index(f) % 3 == 0) {
      std::swap(mesh.faces[f][1], mesh.faces[f][2]);
      ++turned;
    }
  EXPECT_EQ(turn_against_neighbours(mesh), turned);
  EXPECT_EQ(mesh.faces, right.faces);
  EXPECT_EQ(turn_against_neighbours(mesh), 0u);
}

TEST(Orientation, a_surface_without_sides_stays_as_it_is) {
  const TriangleMesh strip = test::moebius_strip(50);
  TriangleMesh mesh = strip;
  EXPECT_EQ(turn_against_neighbours(mesh), 0u);
  EXPECT_EQ(mesh.faces, strip.faces);
}

TEST(Orientation, a_hull_around_the_body_is_turned_and_a_mouth_in_it_is_not) {
  const TriangleMesh body = shapes::icosphere(3, 1.0f), hull = shapes::icosphere(3, 1.05f), mouth = shapes::icosphere(2, 0.2f);
  TriangleMesh outlined = shapes::merged(body, test::flipped(hull));
  EXPECT_EQ(turn_inside_out(outlined), hull.faces.size());
  EXPECT_EQ(outlined.faces, shapes::merged(body, hull).faces);
  TriangleMesh speaking = shapes::merged(body, test::flipped(mouth));
  EXPECT_EQ(turn_inside_out(speaking), 0u);
}

TEST(Orientation, a_flat_sheet_has_no_inside) {
  TriangleMesh sheet = shifted(shapes::sheet(5, 5), {0, 7, 0}), back = test::flipped(sheet);
  EXPECT_EQ(turn_inside_out(sheet), 0u);
  EXPECT_EQ(turn_inside_out(back), 0u);
}

}  // namespace
}  // namespace osteon::geometry
