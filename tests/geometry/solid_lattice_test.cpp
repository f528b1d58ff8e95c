// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/solid_lattice.h"

#include <bit>
#include <numbers>

#include "geometry/mesh_makers.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

double volume(const SolidLattice& lattice) {
  return static_cast<double>(lattice.nodes()) * std::pow(static_cast<double>(lattice.cell), 3.0);
}

// Whether a step leads from x < 0 to x > 0.
bool crosses_the_middle(const SolidLattice& lattice) {
  for (std::uint32_t n = 0; n < lattice.nodes(); ++n)
    for (std::size_t k = 0; k < 26; ++k)
      if (lattice.steps[n] >> k & 1u) {
        const Vec3f to = lattice.positions[n] + lattice.cell * lattice_steps()[k].cast<float>().matrix();
        if (lattice.positions[n].x() < 0 && to.x() > 0) return true;
      }
  return false;
}

TEST(SolidLattice, a_sphere_has_its_volume_whichever_way_its_faces_look) {
  const TriangleMesh sphere = shapes::icosphere(4, 1.0f);
  const double whole = 4.0 / 3.0 * std::numbers::pi;
  EXPECT_NEAR(volume(solid_lattice(sphere, 64)), whole, 0.01 * whole);
  EXPECT_NEAR(volume(solid_lattice(test::flipped(sphere), 64)), whole, 0.01 * whole);
}

TEST(SolidLattice, no_step_leads_from_a_box_into_one_that_touches_it) {
  const TriangleMesh box = shapes::box({1, 1, 1});
  for (const float gap : {0.0f, 0.001f, 0.02f}) {
    const TriangleMesh two =
        shapes::merged(shapes::shifted(box, {-0.5f - 0.5f * gap, 0, 0}), shapes::shifted(box, {0.5f + 0.5f * gap, 0, 0}));
    EXPECT_FALSE(crosses_the_middle(solid_lattice(two, 31))) << gap;
  }
}

TEST(SolidLattice, steps_lead_through_boxes_that_overlap) {
  const TriangleMesh box = shapes::box({1, 1, 1});
  const TriangleMesh two = shapes::merged(shapes::shifted(box, {-0.4f, 0, 0}), shapes::shifted(box, {0.4f, 0, 0}));
  EXPECT_TRUE(crosses_the_middle(solid_lattice(two, 32)));
}

TEST(SolidLattice, every_step_can_be_taken_back) {
  const SolidLattice lattice = solid_lattice(shapes::icosphere(2, 1.0f), 24);
  for (std::uint32_t n = 0; n < lattice.nodes(); ++n)
    for (std::size_t k = 0; k < 26; ++k) {
      if (!(lattice.steps[n] >> k & 1u)) continue;
      const std::uint32_t to = lattice.node_at(lattice.cell_at(lattice.positions[n]) + lattice_steps()[k]);
      ASSERT_NE(to, SolidLattice::kNone);
      EXPECT_TRUE(lattice.steps[to] >> (25 - k) & 1u);
    }
}

TEST(SolidLattice, has_nothing_in_its_margin_even_where_coordinates_are_coarser_than_cells) {
  const SolidLattice lattice = solid_lattice(shapes::shifted(shapes::box({1, 1, 1}), {1e6f, 0, 0}), 256);
  ASSERT_GT(lattice.nodes(), 0u);
  for (const std::uint32_t cell : lattice.cell_of) {
    const int at = static_cast<int>(cell), line = at / lattice.size.z();
    const Eigen::Array3i place(line / lattice.size.y(), line % lattice.size.y(), at % lattice.size.z());
    ASSERT_TRUE((place > 0).all() && (place < lattice.size - 1).all()) << place.transpose();
  }
}

TEST(SolidLattice, a_full_box_gets_larger_cells_when_it_may_have_few) {
  EXPECT_LT(solid_lattice(shapes::box({1, 1, 1}), 256, 300000).nodes(), 400000u);
}

TEST(SolidLattice, a_point_far_beyond_the_grid_is_beyond_it) {
  const SolidLattice lattice = solid_lattice(shapes::icosphere(3, 1.0f), 20);
  for (const float far : {3.0f, 1e9f, 1e38f})
    for (const Vec3f& direction : {Vec3f(1, 0, 0), Vec3f(0, -1, 0), Vec3f(-1, 1, 1)})
      EXPECT_EQ(lattice.node_at(lattice.cell_at(far * direction)), SolidLattice::kNone);
  EXPECT_NE(lattice.node_at(lattice.cell_at(Vec3f::Zero())), SolidLattice::kNone);
}

}  // namespace
}  // namespace osteon::geometry
