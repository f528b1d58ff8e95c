// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/fold.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "osteon/dataset/articulate.h"

namespace osteon::dataset {
namespace {

constexpr float kBlur = 0.5f;

// For every joint the joint that it is folded into, itself where it stays.
PerJoint<JointId> targets(const PreparedCharacter& character, std::size_t joints, const std::optional<Plane>& symmetry, Random& random) {
  const Skeleton& skeleton = character.skeleton;
  const auto partners = mirror_partners(skeleton, symmetry);
  PerJoint<float> moved = moved_by(character), blur;
  PerJoint<JointId> into;
  for (JointId j : skeleton.names.ids()) {
    into.push_back(j);
    blur.push_back(std::exp(kBlur * random.normal()));
    if (partners[j] && *partners[j] < j) blur[j] = blur[*partners[j]];
  }
  const auto kept = [&](JointId j) {
    while (into[j] != j) j = into[j];
    return j;
  };
  const auto fold = [&](JointId j) {
    into[j] = kept(*skeleton.parents[j]);
    moved[into[j]] += moved[j];
  };
  for (std::size_t left = skeleton.size(); left > joints && left > 1;) {
    std::optional<JointId> least;
    for (JointId j : skeleton.names.ids())
      if (skeleton.parents[j] && into[j] == j && (!least || blur[j] * moved[j] < blur[*least] * moved[*least])) least = j;
    fold(*least);
    --left;
    const auto partner = partners[*least];
    if (partner && *partner != *least && into[*partner] == *partner && skeleton.parents[*partner]) {
      fold(*partner);
      --left;
    }
  }
  for (JointId j : skeleton.names.ids()) into[j] = kept(j);
  return into;
}

}  // namespace

PreparedCharacter folded(const PreparedCharacter& character, std::size_t joints, const std::optional<Plane>& symmetry, Random& random) {
  const PerJoint<JointId> into = targets(character, joints, symmetry, random);
  PreparedCharacter out = character;
  out.skeleton = {};
  out.poses.clear();  // of the joints of before
  PerJoint<JointId> renumbered(character.joints());
  for (JointId j : into.ids()) {
    if (into[j] != j) continue;
    const auto parent = character.skeleton.parents[j];
    renumbered[j] = out.skeleton.add(character.skeleton.names[j], parent ? std::optional(renumbered[into[*parent]]) : std::nullopt,
                                     character.skeleton.rest_positions[j], character.skeleton.rest_orientations[j]);
  }
  out.weights = {};
  std::vector<Influence> row;
  for (VertexId v : character.mesh.positions.ids()) {
    row.clear();
    for (const Influence& i : character.weights[v]) row.push_back({renumbered[into[i.joint]], i.weight});
    out.weights.append(row);
  }
  return out;
}

}  // namespace osteon::dataset
