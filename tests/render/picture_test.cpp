// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/picture.h"

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::render {
namespace {

const PictureOptions small{240, 120};

struct Puppet {
  TriangleMesh mesh = shapes::capsule(0.3f, 1.4f);
  Skeleton skeleton;
  SkinWeights weights;
  Puppet() {
    const JointId hip = skeleton.add("hip", std::nullopt, {0, 0.2f, 0});
    skeleton.add("head", hip, {0, 1.2f, 0});
    for (const Vec3f& p : mesh.positions) weights.append(std::vector<Influence>{{JointId(p.y() > 0.7f), 1}});
  }
};

// Columns in which anything but the smooth backdrop is seen, in runs: the number of figures side by side in the given rows.
int figures(const Image& image, int first_row, int last_row) {
  int runs = 0;
  bool on_figure = false;
  for (int x = 0; x < image.width; ++x) {
    bool seen = false;
    for (int y = first_row; y < last_row; ++y) seen |= image.at(x, y)[1] + 40 < image.at(0, y)[1];
    runs += seen && !on_figure;
    on_figure = seen;
  }
  return runs;
}

TEST(Picture, a_mesh_is_shown_from_three_sides) {
  const TriangleMesh mesh = shapes::capsule(0.3f, 1.4f);
  const Image image = character_picture({mesh}, small);
  EXPECT_EQ(image.width, 240);
  EXPECT_EQ(image.height, 120);
  EXPECT_EQ(figures(image, 0, 120), 3);
}

TEST(Picture, a_pose_is_shown_beside) {
  const Puppet puppet;
  const Posed posed{puppet.mesh.positions, puppet.skeleton.rest_positions};
  EXPECT_EQ(figures(character_picture({puppet.mesh, &puppet.skeleton, &puppet.weights, &posed}, small), 0, 120), 4);
}

TEST(Picture, a_long_character_takes_two_rows) {
  const TriangleMesh lying = shapes::box({4, 1, 4});
  const Image image = character_picture({lying}, small);
  EXPECT_EQ(figures(image, 0, 60), 2);
  EXPECT_EQ(figures(image, 60, 120), 1);
}

TEST(Picture, the_skeleton_and_the_weights_show) {
  const Puppet puppet;
  const Image plain = character_picture({puppet.mesh}, small), bones = character_picture({puppet.mesh, &puppet.skeleton}, small),
              weights = character_picture({puppet.mesh, &puppet.skeleton, &puppet.weights}, small);
  EXPECT_FALSE(plain == bones);
  EXPECT_FALSE(bones == weights);
}

TEST(Picture, does_not_depend_on_the_size_or_place_of_the_character) {
  const TriangleMesh mesh = shapes::capsule(0.3f, 1.4f);
  const TriangleMesh other = shapes::transformed(mesh, Transform(Eigen::Translation3f(64, 8, -16) * Eigen::Scaling(4.0f)));
  const Image a = character_picture({mesh}, small), b = character_picture({other}, small);
  int different = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) different += std::abs(a.pixels[i][0] - b.pixels[i][0]) > 8;
  EXPECT_LT(different, 30);  // roundings on the outline
}

TEST(Picture, meshes_without_extent_are_drawn_without_complaint) {
  TriangleMesh point;
  point.positions.push_back({1, 2, 3});
  point.faces.push_back({VertexId{0}, VertexId{0}, VertexId{0}});
  EXPECT_EQ(character_picture({point}, small).height, 120);
  EXPECT_EQ(figures(character_picture({shapes::sheet(1, 1)}, small), 0, 120), 2);  // from the side a sheet is a line of no width
}

}  // namespace
}  // namespace osteon::render
