// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/mirrored_skin.h"

#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::pipelines {
namespace {

const Plane kMirror{Vec3f::UnitX(), 0.0f};

// hips with two legs of two joints each.
Skeleton legs() {
  Skeleton s;
  const JointId hips = s.add("hips", std::nullopt, {0, 1, 0});
  for (float side : {1.0f, -1.0f}) {
    const std::string name = side > 0 ? "left" : "right";
    s.add(name + "_foot", s.add(name + "_leg", hips, {side * 0.1f, 0.9f, 0}), {side * 0.1f, 0.1f, 0});
  }
  return s;
}
const PerJoint<JointId> kPartners{JointId{0}, JointId{3}, JointId{4}, JointId{1}, JointId{2}};

TEST(MirroredSkin, partners_of_joints_are_their_images) {
  const Skeleton s = legs();
  EXPECT_EQ(mirror_partners(s, s.rest_positions, kMirror), kPartners);
}

TEST(MirroredSkin, of_stacked_joints_those_are_partners_whose_parents_are) {
  Skeleton s;
  const JointId root = s.add("root", std::nullopt, {0, 1, 0}), pelvis = s.add("pelvis", root, {0, 1, 0});
  for (const float side : {1.0f, -1.0f}) {
    const Vec3f at(side * 0.1f, 0.9f, 0);
    const std::string name = side > 0 ? "left" : "right";
    const JointId leg = s.add(name + "_leg", pelvis, at);
    s.add(name + "_twist_1", leg, at);
    s.add(name + "_twist_2", leg, at);
  }
  const PerJoint<JointId> expected{root, pelvis, JointId{5}, JointId{6}, JointId{7}, JointId{2}, JointId{3}, JointId{4}};
  EXPECT_EQ(mirror_partners(s, s.rest_positions, kMirror), expected);
}

TEST(MirroredSkin, a_skeleton_with_something_one_sided_has_no_partners) {
  Skeleton sword = legs();
  sword.add("sword", JointId{4}, {-0.5f, 0.1f, 0});
  EXPECT_FALSE(mirror_partners(sword, sword.rest_positions, kMirror));
  Skeleton crossed = legs();
  crossed.parents[JointId{4}] = JointId{1};  // the right foot hangs on the left leg
  EXPECT_FALSE(mirror_partners(crossed, crossed.rest_positions, kMirror));
}

TEST(MirroredSkin, the_mean_with_the_image_is_its_own_image) {
  const TriangleMesh mesh = shapes::box({0.4f, 2, 0.3f});
  Random random(2);
  Matrix weights(8, 5);
  for (float& w : weights.reshaped()) w = random.uniform();
  const Matrix mean = mean_with_image(weights, mesh, kMirror, kPartners);
  EXPECT_LT((mean_with_image(mean, mesh, kMirror, kPartners) - mean).cwiseAbs().maxCoeff(), 1e-6f);
  EXPECT_LT((mean.rowwise().sum().sum() - weights.sum()), 1e-4f);
  const Matrix far = mean_with_image(weights, mesh, {Vec3f::UnitX(), 1.0f}, kPartners);
  EXPECT_EQ(far, weights);
}

TEST(MirroredSkin, mirrored_vertices_get_equal_weights_bit_by_bit) {
  Random random(9);
  const std::size_t pairs = 50, clean = 2 * pairs + 10;
  PerVertex<VertexId> partner, from_original;
  for (std::uint32_t v = 0; v < clean; ++v)
    partner.push_back(VertexId{v < pairs       ? v + static_cast<std::uint32_t>(pairs)
                               : v < 2 * pairs ? v - static_cast<std::uint32_t>(pairs)
                                               : v});
  for (std::uint32_t v = 0; v < 2 * clean; ++v) from_original.push_back(VertexId{v % static_cast<std::uint32_t>(clean)});  // seams
  SkinWeights weights;
  for (std::size_t v = 0; v < from_original.size(); ++v) {
    std::vector<Influence> row;
    for (std::uint16_t j = 0; j < 5; ++j) row.push_back({JointId{j}, random.uniform()});
    weights.append(row, 4);
  }
  const SkinWeights out = mirrored_exactly(weights, from_original, partner, kPartners, 4);
  validate(out, from_original.size(), 5);
  EXPECT_LE(out.max_influences(), 4u);
  const auto weight = [&](VertexId v, JointId j) {
    for (const Influence& i : out[v])
      if (i.joint == j) return i.weight;
    return 0.0f;
  };
  for (VertexId v : partner.ids())
    for (JointId j : kPartners.ids()) {
      EXPECT_EQ(weight(v, j), weight(partner[v], kPartners[j]));
      EXPECT_EQ(weight(v, j), weight(static_cast<VertexId>(index(v) + clean), j));
    }
}

}  // namespace
}  // namespace osteon::pipelines
