// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/character.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "osteon/rig/pose.h"
#include "support/expect.h"

namespace osteon::synth {
namespace {

constexpr CharacterOptions kCoarse{80, Finish::Smooth};
constexpr std::uint64_t kSeeds = 4;

bool is_rigid(Kind kind) { return kind == Kind::Robot || kind == Kind::BlockyAnimal || kind == Kind::BlockyHumanoid; }

// How often the surface winds around a point: about 0 outside and 1 or more inside.
// Van Oosterom, Strackee. The solid angle of a plane triangle. 1983.
double winding(const TriangleMesh& mesh, const Vec3f& p) {
  double sum = 0.0;
  for (const auto& [ia, ib, ic] : mesh.faces) {
    const Eigen::Vector3d a = (mesh.positions[ia] - p).cast<double>(), b = (mesh.positions[ib] - p).cast<double>(),
                          c = (mesh.positions[ic] - p).cast<double>();
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * std::numbers::pi);
}

struct Range {
  std::size_t least, most;
};
// As artists have them, from the plainest to the richest.
Range joints_of(Kind kind) {
  switch (kind) {
    case Kind::Biped:
      return {6, 70};
    case Kind::Quadruped:
      return {6, 45};
    case Kind::Bird:
      return {5, 35};
    case Kind::Fish:
      return {3, 20};
    case Kind::Serpent:
      return {6, 30};
    case Kind::Insect:
      return {4, 45};
    case Kind::Spider:
      return {9, 60};
    case Kind::ManyLegged:
      return {11, 90};
    case Kind::ManyArmed:
      return {10, 100};
    case Kind::Winged:
      return {8, 60};
    case Kind::TailedBiped:
      return {6, 70};
    case Kind::Robot:
      return {8, 30};
    case Kind::Blob:
      return {3, 20};
    case Kind::BlockyAnimal:
      return {6, 17};
    case Kind::BlockyHumanoid:
      return {6, 14};
  }
  return {0, 0};
}

class Characters : public testing::TestWithParam<Kind> {
 protected:
  // Made once.
  static const std::vector<Rig>& some() {
    static std::map<Kind, std::vector<Rig>> made;
    std::vector<Rig>& rigs = made[GetParam()];
    while (rigs.size() < kSeeds) rigs.push_back(make_character(GetParam(), rigs.size() + 1, kCoarse));
    return rigs;
  }
};

TEST_P(Characters, are_valid_rigs_on_the_ground_with_as_many_joints_as_artists_give_them) {
  for (const Rig& rig : some()) {
    validate(rig);
    EXPECT_NEAR(bounds(rig.mesh).min().y(), 0.0f, 1e-6f);
    EXPECT_GE(rig.skeleton.size(), joints_of(GetParam()).least);
    EXPECT_LE(rig.skeleton.size(), joints_of(GetParam()).most);
  }
}

TEST_P(Characters, have_all_joints_but_the_tips_inside) {
  for (const Rig& rig : some())
    for (JointId j : rig.skeleton.names.ids())
      if (!rig.skeleton.names[j].ends_with("End"))
        EXPECT_GT(winding(rig.mesh, rig.skeleton.rest_positions[j]), 0.5) << rig.skeleton.names[j];
}

TEST_P(Characters, have_no_border) {
  for (const Rig& rig : some()) {
    std::map<std::pair<VertexId, VertexId>, int> balance;
    for (const Triangle& face : rig.mesh.faces)
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId a = face[k], b = face[(k + 1) % 3];
        balance[std::minmax(a, b)] += a < b ? 1 : -1;
      }
    for (const auto& [edge, sum] : balance) ASSERT_EQ(sum, 0);
  }
}

TEST_P(Characters, have_symmetric_skeletons_with_twin_names) {
  for (const Rig& rig : some()) {
    std::map<std::string, Vec3f> at;
    for (JointId j : rig.skeleton.names.ids()) at[rig.skeleton.names[j]] = rig.skeleton.rest_positions[j];
    for (const auto& [name, position] : at) {
      if (name.starts_with("Left")) {
        const Vec3f& right = at.at("Right" + name.substr(4));
        EXPECT_VEC3_NEAR(Vec3f(-right.x(), right.y(), right.z()), position, 1e-6f);
      } else if (!name.starts_with("Right")) {
        EXPECT_EQ(position.x(), 0.0f) << name;
      }
    }
  }
}

TEST_P(Characters, bind_something_to_every_joint_but_the_tips) {
  for (const Rig& rig : some()) {
    PerJoint<float> total(rig.skeleton.size(), 0.0f);
    for (VertexId v : rig.mesh.positions.ids())
      for (const Influence& i : rig.weights[v]) total[i.joint] += i.weight;
    for (JointId j : total.ids())
      if (!rig.skeleton.names[j].ends_with("End")) EXPECT_GT(total[j], 0.5f) << rig.skeleton.names[j];
  }
}

TEST_P(Characters, bind_each_vertex_to_one_joint_exactly_where_all_parts_are_rigid) {
  for (const Rig& rig : some()) EXPECT_EQ(rig.weights.max_influences() == 1, is_rigid(GetParam()));
}

TEST_P(Characters, have_weights_that_change_little_along_a_short_edge) {
  for (const Rig& rig : some()) {
    const float longest = 0.015f * bounds(rig.mesh).diagonal().norm();
    std::size_t jumps = 0, edges = 0;
    for (const Triangle& face : rig.mesh.faces)
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId from = face[k], to = face[(k + 1) % 3];
        if ((rig.mesh.positions[from] - rig.mesh.positions[to]).norm() > longest) continue;
        float difference = 0.0f;
        for (const Influence& i : rig.weights[from]) {
          const auto other = std::ranges::find(rig.weights[to], i.joint, &Influence::joint);
          difference += std::max(i.weight - (other == rig.weights[to].end() ? 0.0f : other->weight), 0.0f);
        }
        jumps += difference > 0.6f;
        ++edges;
      }
    // Seams where a limb meets several joints of the trunk.
    EXPECT_LE(static_cast<double>(jumps), 0.03 * static_cast<double>(edges));
  }
}

TEST_P(Characters, have_few_large_faces_where_wanted) {
  const Rig faceted = make_character(GetParam(), 1, {64, Finish::Faceted}), smooth = make_character(GetParam(), 1, {64, Finish::Smooth});
  validate(faceted);
  EXPECT_EQ(faceted.skeleton.names, smooth.skeleton.names);
  if (is_rigid(GetParam()))
    EXPECT_EQ(faceted.mesh.positions, smooth.mesh.positions);
  else
    EXPECT_LT(faceted.mesh.positions.size(), smooth.mesh.positions.size());
}

TEST_P(Characters, follow_from_their_seed) {
  const Rig a = make_character(GetParam(), 7, kCoarse), b = make_character(GetParam(), 7, kCoarse),
            c = make_character(GetParam(), 8, kCoarse);
  EXPECT_EQ(a.mesh.positions, b.mesh.positions);
  EXPECT_EQ(a.mesh.faces, b.mesh.faces);
  EXPECT_EQ(a.weights, b.weights);
  EXPECT_NE(a.mesh.positions, c.mesh.positions);
}

TEST_P(Characters, come_back_by_the_name_of_their_kind) { EXPECT_EQ(kind_of(name(GetParam())), GetParam()); }

INSTANTIATE_TEST_SUITE_P(AllKinds, Characters, testing::ValuesIn(kKinds), [](const auto& test) {
  std::string label(name(test.param));
  std::erase(label, '-');
  return label;
});

TEST(Character, refuses_unknown_kinds_and_fineness) {
  EXPECT_EQ(
      test::error_of([] { kind_of("unicorn"); }),
      "'unicorn' is no kind of character; expected one of biped, quadruped, bird, fish, serpent, insect, spider, many-legged, many-armed, "
      "winged, tailed-biped, robot, blob, blocky-animal, blocky-humanoid");
  EXPECT_EQ(test::error_of([] { make_character(Kind::Fish, 1, {4}); }), "4 cells along the character; expected 16 to 2048");
}

}  // namespace
}  // namespace osteon::synth
