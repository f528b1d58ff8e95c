// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/bind.h"

#include <algorithm>
#include <array>

#include "geometry/mesh_makers.h"
#include "geometry/tube.h"
#include "skin/touching.h"
#include "support/expect.h"
#include "support/numbers.h"

namespace osteon::skin {
namespace {

constexpr std::array kGeometric{Method::rigid, Method::geovoxel, Method::heat, Method::biharmonic};

BindOptions by(Method method) {
  BindOptions options;
  options.method = method;
  options.resolution = 128;
  return options;
}

// A chain of two bones along y through what lies between y = 0 and y = length.
Skeleton chain(float length) {
  Skeleton s;
  const JointId a = s.add("a", std::nullopt, {0, 0.02f, 0});
  const JointId b = s.add("b", a, {0, 0.5f * length, 0});
  s.add("b_end", b, {0, 0.98f * length, 0});
  return s;
}

TEST(Bind, touching_cylinders_keep_their_own_weight) {
  const test::Bound two = test::touching_capsules(2);
  for (const Method method : kGeometric) {
    const Binding binding = bind(two.mesh, two.skeleton, by(method));
    EXPECT_LT(test::largest_foreign_weight(binding.weights, {JointId{1}, JointId{2}},
                                           [&](VertexId v) { return index(v) < two.mesh.positions.size() / 2; }),
              0.01f)
        << static_cast<int>(method);
  }
}

TEST(Bind, fingers_side_by_side_keep_their_own_weight) {
  const test::Bound hand = test::touching_capsules(5);
  const Binding binding = bind(hand.mesh, hand.skeleton, by(Method::geovoxel));
  const std::size_t each = hand.mesh.positions.size() / 5;
  for (std::size_t finger = 0; finger < 5; ++finger)
    EXPECT_LT(test::largest_foreign_weight(binding.weights, {static_cast<JointId>(1 + 2 * finger), static_cast<JointId>(2 + 2 * finger)},
                                           [&](VertexId v) { return index(v) / each == finger; }),
              0.01f);
}

TEST(Bind, legs_of_one_skin_that_touch_keep_their_own_weight) {
  const float radius = 0.1f;
  const test::UTube legs = test::u_tube(radius, 1e-4f, 1.0f);
  Skeleton skeleton;
  const JointId hip = skeleton.add("hip", std::nullopt, {0, -radius, 0});
  for (const float side : {-1.0f, 1.0f}) {
    const JointId leg = skeleton.add(side < 0 ? "left" : "right", hip, {side * radius, 0.2f, 0});
    skeleton.add(side < 0 ? "left_end" : "right_end", leg, {side * radius, 1, 0});
  }
  for (const Method method : kGeometric) {
    const Binding binding = bind(legs.mesh, skeleton, by(method));
    EXPECT_LT(test::largest_foreign_weight(binding.weights, {JointId{1}, JointId{2}},
                                           [&](VertexId v) { return legs.mesh.positions[v].x() < 0 && legs.mesh.positions[v].y() > 0.4f; }),
              0.01f)
        << static_cast<int>(method);
  }
}

TEST(Bind, a_vertex_beside_the_joint_belongs_half_to_each_bone) {
  const TriangleMesh tube = test::tube({{0, 0, 0}, {0, 0.25f, 0}, {0, 0.5f, 0}, {0, 0.75f, 0}, {0, 1, 0}}, 0.1f);
  for (const Method method : {Method::geovoxel, Method::heat}) {
    const Binding binding = bind(tube, chain(1.0f), by(method));
    for (VertexId v : tube.positions.ids()) {
      const float y = tube.positions[v].y();
      float upper = 0.0f;
      for (const Influence& i : binding.weights[v]) upper += i.joint == JointId{0} ? 0.0f : i.weight;
      if (y == 0.5f) EXPECT_NEAR(upper, 0.5f, 0.15f);
      if (y < 0.2f) EXPECT_LT(upper, 0.1f);
      if (y > 0.8f) EXPECT_GT(upper, 0.9f);
    }
  }
}

TEST(Bind, a_small_island_follows_one_joint_unless_it_may_deform) {
  const TriangleMesh arm = test::tube({{0, 0, 0}, {0, 0.25f, 0}, {0, 0.5f, 0}, {0, 0.75f, 0}, {0, 1, 0}}, 0.1f);
  const TriangleMesh button = shapes::shifted(shapes::icosphere(1, 0.04f), {0.1f, 0.53f, 0});
  const TriangleMesh mesh = shapes::merged(arm, button);
  const std::size_t first = arm.positions.size();
  const auto joints_of_button = [&](const SkinWeights& weights) {
    std::vector<JointId> joints;
    for (std::size_t v = first; v < mesh.positions.size(); ++v)
      for (const Influence& i : weights[static_cast<VertexId>(v)])
        if (std::ranges::find(joints, i.joint) == joints.end()) joints.push_back(i.joint);
    return joints.size();
  };
  BindOptions options = by(Method::geovoxel);
  const Binding rigid = bind(mesh, chain(1.0f), options);
  EXPECT_EQ(rigid.rigid_islands, 1u);
  EXPECT_EQ(joints_of_button(rigid.weights), 1u);
  options.islands = Islands::deform;
  EXPECT_GT(joints_of_button(bind(mesh, chain(1.0f), options).weights), 1u);
}

TEST(Bind, the_same_with_one_and_two_threads_and_in_any_order) {
  const test::UTube tube = test::u_tube(0.1f, 0.1f, 1.0f);
  const Skeleton skeleton = chain(1.0f);
  const Binding here = bind(tube.mesh, skeleton, by(Method::geovoxel));
  {
    const test::ScopedThreads one(1);
    EXPECT_EQ(bind(tube.mesh, skeleton, by(Method::geovoxel)).weights, here.weights);
  }
  const TriangleMesh shuffled = test::shuffled(tube.mesh, 3);
  const Binding there = bind(shuffled, skeleton, by(Method::geovoxel));
  for (VertexId v : shuffled.positions.ids())
    for (VertexId w : tube.mesh.positions.ids())
      if (shuffled.positions[v] == tube.mesh.positions[w]) EXPECT_TRUE(std::ranges::equal(there.weights[v], here.weights[w]));
}

TEST(Bind, transfer_from_the_mesh_itself_gives_its_weights_back) {
  const TriangleMesh tube = test::tube({{0, 0, 0}, {0, 0.25f, 0}, {0, 0.5f, 0}, {0, 0.75f, 0}, {0, 1, 0}}, 0.1f);
  const Skeleton skeleton = chain(1.0f);
  const SkinWeights weights = bind(tube, skeleton, by(Method::heat)).weights;
  BindOptions options = by(Method::transfer);
  options.from = Rig{tube, skeleton, weights};
  options.prune_share = 0.0f;
  const SkinWeights again = bind(tube, skeleton, options).weights;
  for (VertexId v : tube.positions.ids())
    for (const Influence& i : weights[v]) {
      const auto found = std::ranges::find(again[v], i.joint, &Influence::joint);
      ASSERT_TRUE(found != again[v].end());
      EXPECT_NEAR(found->weight, i.weight, 1e-5f);
    }
}

TEST(Bind, transfer_continues_the_weights_where_the_reference_ends) {
  const std::vector<Vec3f> path{{0, 0, 0}, {0, 0.25f, 0}, {0, 0.5f, 0}, {0, 0.75f, 0}, {0, 1, 0}};
  const Skeleton skeleton = chain(1.0f);
  const TriangleMesh half = test::tube({path[0], path[1], path[2]}, 0.1f);
  Rig reference{half, skeleton, {}};
  const Influence a{JointId{0}, 1.0f};
  for (std::size_t v = 0; v < half.positions.size(); ++v) reference.weights.append({&a, 1});
  BindOptions options = by(Method::transfer);
  options.from = reference;
  const SkinWeights weights = bind(test::tube(path, 0.1f), skeleton, options).weights;
  for (VertexId v : ids<VertexId>(weights.size())) {
    EXPECT_EQ(weights[v].front().joint, JointId{0});
    EXPECT_EQ(weights[v].size(), 1u);
  }
}

TEST(Bind, a_locked_joint_keeps_its_weights) {
  const TriangleMesh tube = test::tube({{0, 0, 0}, {0, 0.25f, 0}, {0, 0.5f, 0}, {0, 0.75f, 0}, {0, 1, 0}}, 0.1f);
  const Skeleton skeleton = chain(1.0f);
  SkinWeights before;
  const std::array<Influence, 2> row{{{JointId{2}, 0.25f}, {JointId{0}, 0.75f}}};
  for (std::size_t v = 0; v < tube.positions.size(); ++v) before.append(row);
  BindOptions options = by(Method::geovoxel);
  options.locked = {JointId{2}};
  options.before = before;
  const SkinWeights weights = bind(tube, skeleton, options).weights;
  for (VertexId v : tube.positions.ids()) {
    const auto found = std::ranges::find(weights[v], JointId{2}, &Influence::joint);
    ASSERT_TRUE(found != weights[v].end());
    EXPECT_NEAR(found->weight, 0.25f, 1e-6f);
  }
}

TEST(Bind, a_joint_astray_has_no_weight) {
  const TriangleMesh body = shapes::capsule(0.2f, 2.0f, 24, 8);
  for (const float far : {1e5f, 1e9f, 1e15f}) {
    Skeleton skeleton = chain(2.0f);
    const JointId astray = skeleton.add("astray", JointId{0}, {0, 0, far});
    for (const Method method : kGeometric) {
      const SkinWeights weights = bind(body, skeleton, by(method)).weights;
      for (VertexId v : body.positions.ids()) ASSERT_TRUE(std::ranges::find(weights[v], astray, &Influence::joint) == weights[v].end());
    }
  }
}

TEST(Bind, far_from_the_origin_is_as_good_as_near_to_it) {
  const Vec3f away(8e6f, 0, -1e5f);  // where floats are half a unit apart, which is more than a cell
  const TriangleMesh far = shapes::shifted(shapes::capsule(4.0f, 40.0f, 24, 8), away), near = shapes::shifted(far, -away);
  const Skeleton skeleton = chain(40.0f), there = transformed(skeleton, Eigen::Affine3d(Eigen::Translation3d(away.cast<double>())));
  for (const Method method : kGeometric) {
    const SkinWeights a = bind(far, there, by(method)).weights, b = bind(near, skeleton, by(method)).weights;
    const auto same = std::ranges::count_if(far.positions.ids(), [&](VertexId v) { return a[v][0].joint == b[v][0].joint; });
    EXPECT_GT(static_cast<double>(same), 0.98 * static_cast<double>(far.positions.size())) << static_cast<int>(method);
  }
}

TEST(Bind, a_mesh_without_area_says_so) {
  TriangleMesh mesh;
  for (int i = 0; i < 3; ++i) mesh.positions.push_back({static_cast<float>(i), 0, 0});
  mesh.faces.push_back({VertexId{0}, VertexId{1}, VertexId{2}});
  EXPECT_THAT(test::error_of([&] { bind(mesh, chain(1.0f)); }), testing::HasSubstr("no face with an area"));
}

}  // namespace
}  // namespace osteon::skin
