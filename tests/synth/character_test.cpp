// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/character.h"

#include <algorithm>
#include <map>

#include "osteon/rig/pose.h"
#include "support/expect.h"

namespace osteon::synth {
namespace {

const CharacterOptions kCoarse{160};  // the thinnest fingers are two cells wide

class Characters : public testing::TestWithParam<Kind> {
 protected:
  // Made once: two characters of the kind.
  static const std::vector<Rig>& some() {
    static std::map<Kind, std::vector<Rig>> made;
    std::vector<Rig>& rigs = made[GetParam()];
    for (std::uint64_t seed = 1; rigs.size() < 2; ++seed) rigs.push_back(make_character(GetParam(), seed, kCoarse));
    return rigs;
  }
};

TEST_P(Characters, are_valid_rigs_in_one_piece_on_the_ground) {
  for (const Rig& rig : some()) {
    validate(rig);
    EXPECT_EQ(connected_components(rig.mesh).count, 1u);
    EXPECT_NEAR(bounds(rig.mesh).min().y(), 0.0f, 1e-6f);
    EXPECT_GE(rig.skeleton.size(), 12u);
  }
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

TEST_P(Characters, are_symmetric_with_twin_names) {
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
    const auto box = bounds(rig.mesh);
    EXPECT_NEAR(box.min().x(), -box.max().x(), 1e-4f);
  }
}

TEST_P(Characters, bind_something_to_every_joint) {
  for (const Rig& rig : some()) {
    PerJoint<float> total(rig.skeleton.size(), 0.0f);
    for (VertexId v : rig.mesh.positions.ids())
      for (const Influence& i : rig.weights[v]) total[i.joint] += i.weight;
    for (JointId j : total.ids()) EXPECT_GT(total[j], 0.5f) << rig.skeleton.names[j];
  }
}

TEST_P(Characters, have_weights_that_change_little_along_an_edge) {
  for (const Rig& rig : some()) {
    std::size_t jumps = 0, edges = 0;
    for (const Triangle& face : rig.mesh.faces)
      for (std::size_t k = 0; k < 3; ++k, ++edges) {
        float difference = 0.0f;
        const auto a = rig.weights[face[k]], b = rig.weights[face[(k + 1) % 3]];
        for (const Influence& i : a) {
          const auto other = std::find_if(b.begin(), b.end(), [&](const Influence& o) { return o.joint == i.joint; });
          difference += std::max(i.weight - (other == b.end() ? 0.0f : other->weight), 0.0f);
        }
        jumps += difference > 0.6f;
      }
    EXPECT_LT(static_cast<double>(jumps) / static_cast<double>(edges), 0.02);  // seams where a fin meets several joints of the trunk
  }
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
  EXPECT_EQ(test::error_of([] { kind_of("dragon"); }),
            "'dragon' is no kind of character; expected one of biped, quadruped, bird, fish, many-legged");
  EXPECT_EQ(test::error_of([] { make_character(Kind::Fish, 1, {4}); }), "4 cells along the character; expected 16 to 2048");
}

}  // namespace
}  // namespace osteon::synth
