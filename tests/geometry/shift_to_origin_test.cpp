// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/shift_to_origin.h"

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

TEST(ShiftToOrigin, brings_a_mesh_near_without_rounding) {
  for (const Vec3f& away : {Vec3f(1e6f, -3e4f, 0.5f), Vec3f(-17.3f, 1e15f, 100.1f)}) {
    const TriangleMesh far = shapes::shifted(shapes::icosphere(2, 0.9f), away);
    const Vec3f shift = shift_to_origin(far);
    const TriangleMesh near = shapes::shifted(far, shift);
    EXPECT_LT(bounds(near).center().cwiseAbs().maxCoeff(), 17 * bounds(far).sizes().maxCoeff());
    for (VertexId v : far.positions.ids())
      EXPECT_EQ(near.positions[v].cast<double>() - shift.cast<double>(), far.positions[v].cast<double>());
  }
}

TEST(ShiftToOrigin, leaves_a_mesh_that_stands_near_where_it_is) {
  EXPECT_TRUE(shift_to_origin(shapes::shifted(shapes::box({1, 2, 1}), {0, 1, 5})).isZero(0));
}

}  // namespace
}  // namespace osteon::geometry
