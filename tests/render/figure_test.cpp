// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/figure.h"

#include <cmath>

#include "osteon/base/parallel.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::render {
namespace {

constexpr int kSize = 120;
const Vec3f red(0.6f, 0.05f, 0.05f), blue(0.05f, 0.05f, 0.6f);

struct Colored {
  TriangleMesh mesh;
  PerVertex<Vec3f> colors;
  Colored(TriangleMesh m, const Vec3f& color) : mesh(std::move(m)), colors(mesh.positions.size(), color) {}
};

Camera front(float pixels_per_metre) { return {view_axes({}), Vec3f::Zero(), {kSize / 2.0f, kSize / 2.0f}, pixels_per_metre}; }

bool is_red(const std::array<std::uint8_t, 3>& p) { return p[0] > p[2] + 40; }
bool is_blue(const std::array<std::uint8_t, 3>& p) { return p[2] > p[0] + 40; }
bool is_covered(const std::array<std::uint8_t, 3>& p) { return p[1] < 190; }  // the backdrop is brighter

TEST(Figure, a_symmetric_character_has_a_symmetric_outline_of_its_area) {
  const Colored ball(shapes::icosphere(5), red);
  const Image image = draw({ball.mesh, ball.colors}, front(50), kSize, kSize);
  int covered = 0, different = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      covered += is_covered(image.at(x, y));
      different += is_covered(image.at(x, y)) != is_covered(image.at(kSize - 1 - x, y));
    }
  EXPECT_NEAR(covered, 3.1416 * 50 * 50, 0.02 * 3.1416 * 50 * 50);
  EXPECT_LE(different, 4);  // the outline is bright on the side of the light and may cross the threshold there
}

TEST(Figure, the_edge_is_smooth) {
  const Colored box(shapes::box({1, 1, 1}), Vec3f::Zero());
  Camera camera = front(60);
  camera.centre.x() += 0.5f;  // the vertical edges run through the middle of a column of pixels
  const Image image = draw({box.mesh, box.colors}, camera, kSize, kSize);
  const int inside = image.at(kSize / 2, kSize / 2)[0], outside = image.at(5, kSize / 2)[0], edge = image.at(30, kSize / 2)[0];
  EXPECT_GT(edge, inside + 20);
  EXPECT_LT(edge, outside - 20);
}

TEST(Figure, light_comes_from_above) {
  const Colored ball(shapes::icosphere(4), Vec3f::Constant(0.5f));
  const Image image = draw({ball.mesh, ball.colors}, front(50), kSize, kSize);
  EXPECT_GT(image.at(kSize / 2, kSize / 2 - 35)[0], image.at(kSize / 2, kSize / 2 + 35)[0] + 30);
}

TEST(Figure, what_is_inside_shows_through) {
  const Colored ball(shapes::icosphere(3), red);
  const ColoredMesh inside{shapes::icosphere(3, 0.3f), PerVertex<Vec3f>(642, blue)};
  EXPECT_TRUE(is_red(draw({ball.mesh, ball.colors}, front(50), kSize, kSize).at(kSize / 2, kSize / 2)));
  const Image image = draw({ball.mesh, ball.colors, &inside}, front(50), kSize, kSize);
  EXPECT_TRUE(is_blue(image.at(kSize / 2, kSize / 2)));
  EXPECT_TRUE(is_red(image.at(kSize / 2 + 25, kSize / 2)));
}

TEST(Figure, the_inner_side_of_an_open_sheet_is_lit_too) {
  const Colored sheet(shapes::sheet(4, 4), Vec3f::Constant(0.5f));
  Camera front_side = front(80), back_side = front(80);
  front_side.target = back_side.target = {0.5f, 0.5f, 0};
  back_side.axes = view_axes({3.1415927f, 0});
  const int a = draw({sheet.mesh, sheet.colors}, front_side, kSize, kSize).at(60, 60)[0];
  const int b = draw({sheet.mesh, sheet.colors}, back_side, kSize, kSize).at(60, 60)[0];
  EXPECT_NEAR(a, b, 2);
}

TEST(Figure, one_and_two_threads_draw_the_same_bytes) {
  const Colored ball(shapes::icosphere(4), red);
  const Camera camera{view_axes({0.4f, 0.2f}), Vec3f::Zero(), {60, 60}, 40};
  const int before = threads();
  set_threads(1);
  const Image one = draw({ball.mesh, ball.colors}, camera, kSize, kSize);
  set_threads(2);
  const Image two = draw({ball.mesh, ball.colors}, camera, kSize, kSize);
  set_threads(before);
  EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace osteon::render
