// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skin_character.h"

#include <algorithm>
#include <set>

#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "osteon/pipelines/skeleton_fit.h"
#include "osteon/pipelines/skin_quality.h"
#include "pipelines/biped.h"
#include "skin/heaps.h"
#include "support/expect.h"

namespace osteon::pipelines {
namespace {

TEST(SkinCharacter, mirror_makes_the_halves_equal_bit_by_bit) {
  Rig rig = test::biped();
  const auto mirror = mirror_map(rig.mesh, rig.skeleton);
  if (!mirror) GTEST_SKIP() << "this character wears something on one side";
  SkinCharacterOptions options;
  options.bind.resolution = 64;
  options.mirror = true;
  rig.weights = skin_character(rig.mesh, rig.skeleton, options).weights;
  validate(rig);
  PerVertex<std::optional<VertexId>> original(mirror->vertex_partner.size());
  for (VertexId v : rig.mesh.positions.ids()) original[mirror->from_original[v]] = v;
  for (VertexId v : rig.mesh.positions.ids()) {
    const auto image = rig.weights[*original[mirror->vertex_partner[mirror->from_original[v]]]];
    ASSERT_EQ(image.size(), rig.weights[v].size());
    for (const Influence& i : rig.weights[v]) {
      const auto found = std::ranges::find(image, mirror->joint_partner[i.joint], &Influence::joint);
      ASSERT_TRUE(found != image.end());
      EXPECT_EQ(found->weight, i.weight);
    }
  }
  EXPECT_LT(*skin_quality(rig).asymmetry, 1e-6);
}

TEST(SkinCharacter, symmetry_does_not_depend_on_vertices_that_no_face_uses) {
  Rig rig = test::biped();
  if (!mirror_map(rig.mesh, rig.skeleton)) GTEST_SKIP() << "this character wears something on one side";
  rig.mesh.positions.push_back({30, 0, 0});
  EXPECT_TRUE(mirror_map(rig.mesh, rig.skeleton));
}

TEST(SkinCharacter, mirror_says_so_where_nothing_is_symmetric) {
  Rig rig = test::biped();
  rig.skeleton.rest_positions[JointId{1}].x() += 0.2f;
  SkinCharacterOptions options;
  options.bind.resolution = 32;
  options.mirror = true;
  EXPECT_THAT(test::error_of([&] { skin_character(rig.mesh, rig.skeleton, options); }), testing::HasSubstr("mirror"));
}

// Beads along an arm from its joint on: where weights of two bones meet, at least one of them would bend.
TEST(SkinCharacter, by_networks_a_small_island_follows_one_joint_unless_it_may_deform) {
  static const auto models = infer::RignetModels::load();
  const Rig rig = test::biped();
  const auto bone_list = bones(rig.skeleton);
  const auto arm = std::ranges::max_element(bone_list, {}, [](const Bone& b) { return b.end ? std::abs(b.segment.b.x()) : 0.0f; });
  const std::size_t body = rig.mesh.positions.size();
  TriangleMesh mesh = rig.mesh;
  constexpr std::size_t beads = 6;
  const TriangleMesh bead = shapes::icosphere(2, 0.03f);
  for (std::size_t k = 0; k < beads; ++k)
    mesh = shapes::merged(
        mesh, shapes::transformed(
                  bead, Transform(Eigen::Translation3f(arm->segment.a + 0.05f * static_cast<float>(k) * (arm->segment.b - arm->segment.a) +
                                                       Vec3f(0, 0, 0.3f + 0.08f * static_cast<float>(k))))));
  const auto bending_beads = [&](const SkinCharacterOptions& options) {
    const SkinWeights weights = skin_character(mesh, rig.skeleton, options).weights;
    validate(weights, mesh.positions.size(), rig.skeleton.size());
    std::size_t bending = 0;
    for (std::size_t k = 0; k < beads; ++k) {
      std::set<JointId> joints;
      for (std::size_t v = 0; v < bead.positions.size(); ++v)
        for (const Influence& i : weights[static_cast<VertexId>(body + k * bead.positions.size() + v)]) joints.insert(i.joint);
      bending += joints.size() > 1 ? 1 : 0;
    }
    return bending;
  };
  for (const bool both : {false, true}) {
    SkinCharacterOptions options{.rignet = &models, .neuroskinning = both ? models.neuroskinning() : nullptr};
    const std::size_t rigid = bending_beads(options);
    options.bind.islands = skin::Islands::deform;
    EXPECT_LT(rigid, bending_beads(options));
  }
}

TEST(SkinCharacter, networks_smooth_and_prune_as_they_are_told) {
  static const auto models = infer::RignetModels::load();
  const Rig rig = test::biped();
  const auto influences = [&](SkinCharacterOptions options) {
    const SkinWeights weights = skin_character(rig.mesh, rig.skeleton, options).weights;
    std::size_t sum = 0;
    for (VertexId v : rig.mesh.positions.ids()) sum += weights[v].size();
    return sum;
  };
  for (const bool neuro : {false, true}) {
    SkinCharacterOptions options;
    if (neuro)
      options.neuroskinning = models.neuroskinning();
    else
      options.rignet = &models;
    SkinCharacterOptions pruned = options, smooth = options;
    pruned.bind.prune_share = 0.9f;
    smooth.bind.smooth = 4;
    EXPECT_LT(influences(pruned), influences(options));
    EXPECT_GT(influences(smooth), influences(options));
  }
}

TEST(SkinCharacter, networks_heard_together_differ_from_either_and_are_valid) {
  static const auto models = infer::RignetModels::load();
  const Rig rig = test::biped();
  ASSERT_NE(models.neuroskinning(), nullptr);
  const SkinWeights one = skin_character(rig.mesh, rig.skeleton, {.rignet = &models}).weights,
                    other = skin_character(rig.mesh, rig.skeleton, {.neuroskinning = models.neuroskinning()}).weights,
                    both = skin_character(rig.mesh, rig.skeleton, {.rignet = &models, .neuroskinning = models.neuroskinning()}).weights;
  validate(both, rig.mesh.positions.size(), rig.skeleton.size());
  EXPECT_NE(both, one);
  EXPECT_NE(both, other);
}

TEST(SkinCharacter, by_networks_every_vertex_of_a_heap_of_pieces_has_weights) {
  static const auto models = infer::RignetModels::load();
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    const TriangleMesh mesh = test::heap_of_pieces(random);
    const Skeleton skeleton = test::any_skeleton(random);
    SCOPED_TRACE(seed);
    SkinCharacterOptions options;
    options.rignet = &models;
    if (seed % 2 == 0) options.neuroskinning = models.neuroskinning();
    test::expect_exact(skin_character(mesh, skeleton, options).weights, mesh, skeleton);
  }
}

TEST(SkinCharacter, the_ground_follows_the_root_and_changes_nothing_else) {
  const Rig rig = test::biped();
  const TriangleMesh ground = shapes::shifted(shapes::box({50, 0.1f, 50}), {0, bounds(rig.mesh).min().y() - 0.05f, 0});
  const TriangleMesh mesh = shapes::merged(ground, rig.mesh);
  SkinCharacterOptions options;
  options.bind.resolution = 64;
  const SkinWeights alone = skin_character(rig.mesh, rig.skeleton, options).weights;
  const skin::Binding bound = skin_character(mesh, rig.skeleton, options);
  EXPECT_THAT(bound.notes, testing::Contains(testing::HasSubstr("8 of")));
  SkinWeights expected;
  const Influence root{JointId(0), 1.0f}, locked{JointId(3), 1.0f};
  for (std::size_t v = 0; v < 8; ++v) expected.append({&root, 1});
  for (VertexId v : rig.mesh.positions.ids()) expected.append(alone[v]);
  EXPECT_EQ(bound.weights, expected);

  options.bind.locked = {locked.joint};
  SkinWeights before;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) before.append({v < 8 ? &locked : &root, 1});
  options.bind.before = before;
  const SkinWeights kept = skin_character(mesh, rig.skeleton, options).weights;
  for (std::uint32_t v = 0; v < 8; ++v) EXPECT_EQ(kept[VertexId{v}].front(), locked);
}

TEST(SkinQuality, a_skin_by_its_own_bones_leaks_less_than_one_by_any) {
  Rig rig = test::biped();
  const SkinQuality good = skin_quality(rig);
  EXPECT_EQ(good.unweighted, 0u);
  EXPECT_LT(good.largest_sum_error, 1e-6);
  EXPECT_GT(good.coverage, 0.9);
  SkinWeights scattered;
  for (VertexId v : rig.mesh.positions.ids()) {
    const Influence any{static_cast<JointId>(index(v) * 7 % rig.skeleton.size()), 1.0f};
    scattered.append({&any, 1});
  }
  rig.weights = scattered;
  const SkinQuality bad = skin_quality(rig);
  EXPECT_GT(bad.leak, 0.5);
  EXPECT_LT(good.leak, 0.1);
  EXPECT_GT(bad.roughness, good.roughness);
  EXPECT_GT(bad.deformation.mean.stretch, good.deformation.mean.stretch);
}

TEST(SkeletonFit, leaves_a_skeleton_that_fits_alone) {
  Rig rig = test::biped();
  rig.mesh.positions.push_back({30, 0, 0});  // no face uses it
  const SkeletonFit fit = fit_skeleton(rig.skeleton, rig.mesh);
  EXPECT_TRUE(fit.to_body.matrix().isIdentity(0.0));
  EXPECT_EQ(fit.note, "");
}

TEST(SkeletonFit, what_is_beside_the_body_does_not_count) {
  Rig rig = test::biped();
  rig.mesh = shapes::merged(rig.mesh, shapes::shifted(shapes::icosphere(0, 0.01f), {50, 0, 0}));
  EXPECT_EQ(fit_skeleton(rig.skeleton, rig.mesh).note, "");
}

TEST(SkeletonFit, finds_centimetres_and_the_other_up_axis) {
  const Rig rig = test::biped();
  const Eigen::Affine3d mistake(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX()) * Eigen::Scaling(100.0));
  const SkeletonFit fit = fit_skeleton(transformed(rig.skeleton, mistake), rig.mesh);
  EXPECT_TRUE((fit.to_body * mistake).matrix().isApprox(Eigen::Matrix4d::Identity(), 1e-6)) << fit.note;
  EXPECT_THAT(fit.note, testing::HasSubstr("0.01"));
}

TEST(SkeletonFit, scales_any_other_size_to_the_body) {
  const Rig rig = test::biped();
  const Skeleton other = transformed(rig.skeleton, Eigen::Affine3d(Eigen::Translation3d(7, 3, 0) * Eigen::Scaling(4.3)));
  const SkeletonFit fit = fit_skeleton(other, rig.mesh);
  const Skeleton fitted = transformed(other, fit.to_body);
  Eigen::AlignedBox3f box = bounds(rig.mesh);
  for (const Vec3f& p : fitted.rest_positions) EXPECT_LT(box.exteriorDistance(p), 0.3f);
  EXPECT_THAT(fit.note, testing::HasSubstr("please check"));
}

}  // namespace
}  // namespace osteon::pipelines
