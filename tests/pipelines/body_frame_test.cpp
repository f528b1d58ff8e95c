// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/body_frame.h"

#include "osteon/geometry/stance.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::pipelines {
namespace {

const Vec3f kSides[] = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}};

// A trunk on y = 0 with a finely modelled face at +z.
TriangleMesh trunk() {
  return shapes::merged(shapes::shifted(shapes::box({0.5f, 1, 0.3f}), {0, 0.5f, 0}),
                        shapes::shifted(shapes::icosphere(2, 0.1f), {0, 0.9f, 0.15f}));
}

TEST(BodyFrame, is_the_same_for_a_mesh_turned_by_right_angles) {
  const TriangleMesh mesh = trunk(), in_frame = turned(mesh, body_frame(mesh, Up::automatic).turn);
  for (const Vec3f& side : kSides)
    for (bool z_up : {false, true}) {
      const Eigen::Matrix3f up = z_up ? Eigen::Matrix3f(geometry::turn_z_up_to_y_up().transpose()) : Eigen::Matrix3f::Identity();
      const TriangleMesh other = turned(mesh, up * geometry::turn_to_front(side));
      const BodyFrame frame = body_frame(other, Up::automatic);
      EXPECT_EQ(frame.is_z_up, z_up);
      EXPECT_FALSE(frame.is_seen_from_behind);
      EXPECT_EQ(turned(other, frame.turn).positions, in_frame.positions);
    }
}

TEST(BodyFrame, has_y_up_where_that_is_asked_for) {
  const TriangleMesh mesh = turned(trunk(), geometry::turn_z_up_to_y_up().transpose());
  EXPECT_TRUE(body_frame(mesh, Up::automatic).is_z_up);
  EXPECT_FALSE(body_frame(mesh, Up::y).is_z_up);
  EXPECT_EQ(body_frame(mesh, Up::y).turn * Vec3f::UnitY(), Vec3f::UnitY());
}

TEST(BodyFrame, of_a_shape_alike_before_and_behind_has_the_widest_side_along_x_and_the_front_of_the_file) {
  for (const Vec3f& side : kSides) {
    const TriangleMesh mesh = turned(shapes::shifted(shapes::box({0.5f, 1, 0.3f}), {0, 0.5f, 0}), geometry::turn_to_front(side));
    const BodyFrame frame = body_frame(mesh, Up::automatic);
    EXPECT_FLOAT_EQ(bounds(turned(mesh, frame.turn)).sizes().x(), 0.5f);
    EXPECT_EQ(frame.is_seen_from_behind, (frame.turn * Vec3f::UnitZ()).z() < -0.5f);
  }
}

TEST(BodyFrame, does_not_look_at_vertices_that_no_face_uses) {
  TriangleMesh mesh = shapes::shifted(shapes::box({0.5f, 1, 0.3f}), {0, 0.5f, 0});
  mesh.positions.push_back({0, 0, 30});
  EXPECT_TRUE(body_frame(mesh, Up::automatic).turn.isIdentity(0));
}

TEST(BodyFrame, is_aligned_with_the_plane_of_symmetry) {
  for (float angle : {0.3f, 1.2f, -0.6f}) {
    const Eigen::Matrix3f turn = Eigen::AngleAxisf(angle, Vec3f::UnitY()).toRotationMatrix();
    const TriangleMesh mesh = turned(trunk(), turn);
    const BodyFrame before = body_frame(mesh, Up::automatic);
    const auto frame = aligned(before, {before.turn * turn * Vec3f::UnitX(), 0.0f}, mesh);
    ASSERT_TRUE(frame);
    EXPECT_TRUE((frame->turn * turn).isIdentity(1e-5f)) << frame->turn * turn;
    EXPECT_FALSE(aligned(*frame, {frame->turn * turn * Vec3f::UnitX(), 0.0f}, mesh));
  }
  EXPECT_FALSE(aligned({}, {Vec3f::UnitY(), 0.0f}, trunk()));
}

}  // namespace
}  // namespace osteon::pipelines
