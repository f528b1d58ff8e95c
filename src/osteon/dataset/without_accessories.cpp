// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/without_accessories.h"

#include <optional>
#include <vector>

namespace osteon::dataset {
namespace {

constexpr float kLargest = 0.5f;      // diagonal of an accessory's bounding box; longest side of the character = 1
constexpr float kWhole = 0.95f;       // weight of a joint that a vertex follows as a whole
constexpr float kKeptOfJoint = 0.5f;  // share of what a joint moves that it keeps
constexpr float kLeastVertices = 2.0f / 3.0f;

struct Island {
  std::vector<VertexId> vertices;
  Eigen::AlignedBox3f box;
  std::optional<JointId> joint;  // that all of it follows
};

std::vector<Island> islands_of(const PreparedCharacter& character) {
  const Components components = connected_components(character.mesh);
  std::vector<Island> islands(components.count);
  for (VertexId v : character.mesh.positions.ids()) {
    Island& island = islands[components.of[v]];
    const Influence& most = character.weights[v].front();
    const std::optional<JointId> follows = most.weight >= kWhole ? std::optional(most.joint) : std::nullopt;
    island.joint = island.vertices.empty() || island.joint == follows ? follows : std::nullopt;
    island.vertices.push_back(v);
    island.box.extend(character.mesh.positions[v]);
  }
  return islands;
}

// What each joint moves together with all below it.
PerJoint<float> with_those_below(const Skeleton& skeleton, PerJoint<float> moved) {
  for (std::size_t j = skeleton.size(); j-- > 0;)
    if (const auto parent = skeleton.parents[JointId(static_cast<std::uint16_t>(j))])
      moved[*parent] += moved[JointId(static_cast<std::uint16_t>(j))];
  return moved;
}

// What is left, while accessories are taken away one after the other.
class Remainder {
 public:
  explicit Remainder(const PreparedCharacter& character)
      : character_(character),
        moved_(moved_by(character)),
        vertices_(character.vertices()),
        keeps_(character.vertices(), true),
        stays_(character.joints(), true) {}

  bool changed() const { return vertices_ < character_.vertices(); }

  void take_away(const Island& island) {
    if (!island.joint || island.box.diagonal().norm() > kLargest) return;
    const auto size = static_cast<float>(island.vertices.size());
    if (static_cast<float>(vertices_) - size < kLeastVertices * static_cast<float>(character_.vertices())) return;
    const float own = moved_[*island.joint], left = own - size;
    const bool ends = with_those_below(character_.skeleton, moved_)[*island.joint] - size < kNothing * size;
    if (!ends && left < kKeptOfJoint * own) return;
    if (ends && !character_.skeleton.parents[*island.joint]) return;
    moved_[*island.joint] = left;
    vertices_ -= island.vertices.size();
    for (const VertexId v : island.vertices) keeps_[v] = false;
    if (ends) stays_[*island.joint] = false;
  }

  PreparedCharacter character() const {
    PreparedCharacter out = character_;
    out.poses.clear();
    const PerJoint<JointId> joints = keep_joints(out);
    keep_vertices(out, joints);
    normalise_again(out);
    return out;
  }

 private:
  static constexpr float kNothing = 0.05f;  // of an accessory's weight: what may be left of it elsewhere

  // Returns for each joint the one that stands for it: itself, or the nearest above that stays.
  PerJoint<JointId> keep_joints(PreparedCharacter& out) const {
    const Skeleton& all = character_.skeleton;
    PerJoint<JointId> renumbered;
    PerJoint<bool> stays = stays_;
    out.skeleton = {};
    for (JointId j : all.names.ids()) {
      const auto parent = all.parents[j];
      stays[j] = stays[j] && (!parent || stays[*parent]);
      renumbered.push_back(stays[j] ? out.skeleton.add(all.names[j], parent ? std::optional(renumbered[*parent]) : std::nullopt,
                                                       all.rest_positions[j], all.rest_orientations[j])
                                    : renumbered[*parent]);
    }
    return renumbered;
  }

  void keep_vertices(PreparedCharacter& out, const PerJoint<JointId>& joints) const {
    PerVertex<VertexId> renumbered(character_.vertices());
    out.mesh = {};
    out.weights = {};
    out.attention.clear();
    std::vector<Influence> row;
    for (VertexId v : keeps_.ids()) {
      if (!keeps_[v]) continue;
      out.attention.push_back(character_.attention[index(v)]);
      renumbered[v] = out.mesh.positions.push_back(character_.mesh.positions[v]);
      row.clear();
      for (const Influence& i : character_.weights[v]) row.push_back({joints[i.joint], i.weight});
      out.weights.append(row);
    }
    for (const Triangle& f : character_.mesh.faces)
      if (keeps_[f[0]]) out.mesh.faces.push_back({renumbered[f[0]], renumbered[f[1]], renumbered[f[2]]});
  }

  const PreparedCharacter& character_;
  PerJoint<float> moved_;
  std::size_t vertices_;
  PerVertex<bool> keeps_;
  PerJoint<bool> stays_;
};

}  // namespace

PreparedCharacter without_accessories(const PreparedCharacter& character, float share, Random& random) {
  std::vector<Island> islands = islands_of(character);
  random.shuffle<Island>(islands);
  Remainder remainder(character);
  for (const Island& island : islands)
    if (random.uniform() < share) remainder.take_away(island);
  return remainder.changed() ? remainder.character() : character;
}

}  // namespace osteon::dataset
