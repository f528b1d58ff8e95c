// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/bone_choices.h"

#include <algorithm>
#include <vector>

#include "osteon/geometry/body_lattice.h"
#include "osteon/geometry/neighbourhoods.h"
#include "osteon/skin/binding_bones.h"
#include "osteon/skin/bone_distances.h"
#include "osteon/skin/islands.h"
#include "osteon/skin/weight_rows.h"

namespace osteon::skin {
namespace {

// What NeuroSkinning learned with; geodesic voxel binding itself has others by now.
constexpr FalloffOptions kFalloff{.power = 12.0f, .margin = 0.002f};

geometry::BoneList list_of(std::span<const Bone> bones) {
  geometry::BoneList list;
  for (const Bone& bone : bones) {
    list.segments.push_back(bone.segment);
    list.starts.push_back(static_cast<int>(bone.start));
    list.ends.push_back(bone.end ? static_cast<int>(*bone.end) : -1);
  }
  return list;
}

float share_of(const WeightRow& row, JointId joint) {
  const auto found = std::ranges::find(row, joint, &Influence::joint);
  return found == row.end() ? 0.0f : found->weight;
}

}  // namespace

BoneChoices bone_choices(const TriangleMesh& mesh, const Skeleton& skeleton, const BoneChoiceOptions& options) {
  geometry::BodyLattice body(mesh, {.resolution = options.resolution});
  const std::vector<Bone> bones = binding_bones(skeleton, body);
  BoneDistances distances = bone_distances(body, bones);
  lengthen_past_ends(distances, mesh.positions, bones, skeleton);
  WeightRows shares = falloff_weights(distances, bones, bounds(mesh).sizes().maxCoeff(), kFalloff);
  make_islands_rigid(shares, mesh, skeleton);
  shares = smoothed(std::move(shares), geometry::one_ring(mesh), 1);

  const auto rows = static_cast<Eigen::Index>(mesh.positions.size()), columns = static_cast<Eigen::Index>(options.most);
  BoneChoices out{list_of(bones), geometry::IndexMatrix::Constant(rows, columns, -1), Matrix::Zero(rows, columns),
                  Matrix::Zero(rows, columns)};
  std::vector<JointId> seen;
  for (VertexId v : mesh.positions.ids()) {
    seen.clear();
    for (const auto& [bone, distance] : distances.of(v)) {
      const JointId joint = bones[bone].start;
      if (seen.size() == options.most || std::ranges::find(seen, joint) != seen.end()) continue;
      const auto row = static_cast<Eigen::Index>(index(v)), column = static_cast<Eigen::Index>(seen.size());
      out.nearest(row, column) = static_cast<int>(bone);
      out.distances(row, column) = distance;
      out.shares(row, column) = share_of(shares[v], joint);
      seen.push_back(joint);
    }
  }
  return out;
}

}  // namespace osteon::skin
