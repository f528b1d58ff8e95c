// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/prepared.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

#include "osteon/dataset/clean_targets.h"
#include "osteon/geometry/bvh.h"
#include "osteon/geometry/joint_rays.h"
#include "osteon/geometry/volumetric_geodesic.h"

namespace osteon::dataset {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();  // distance of the bones that are not among the nearest: left out

TriangleMesh normalised(TriangleMesh mesh, const geometry::Normalization& normalization) {
  for (Vec3f& p : mesh.positions) p = normalization.apply(p);
  return mesh;
}

Skeleton normalised(Skeleton skeleton, const geometry::Normalization& normalization) {
  for (Vec3f& p : skeleton.rest_positions) p = normalization.apply(p);
  return skeleton;
}

std::vector<Segment> segments(std::span<const Bone> bones) {
  std::vector<Segment> out;
  for (const Bone& bone : bones) out.push_back(bone.segment);
  return out;
}

std::vector<std::uint8_t> leaf_flags(std::span<const Bone> bones) {
  std::vector<std::uint8_t> out;
  for (const Bone& bone : bones) out.push_back(bone.end ? 0 : 1);
  return out;
}

std::vector<int> starts(std::span<const Bone> bones) {
  std::vector<int> out;
  for (const Bone& bone : bones) out.push_back(static_cast<int>(bone.start));
  return out;
}

// Keeps the nearest bones of every vertex: by distance, then by bone index.
void keep_nearest(const Matrix& distances, int most, PreparedCharacter& out) {
  const Eigen::Index kept = std::min<Eigen::Index>(most, distances.cols());
  out.nearest_bones.resize(distances.rows(), kept);
  out.nearest_distances.resize(distances.rows(), kept);
  std::vector<int> order(static_cast<std::size_t>(distances.cols()));
  for (Eigen::Index v = 0; v < distances.rows(); ++v) {
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return distances(v, a) < distances(v, b); });
    for (Eigen::Index k = 0; k < kept; ++k) {
      out.nearest_bones(v, k) = order[static_cast<std::size_t>(k)];
      out.nearest_distances(v, k) = distances(v, order[static_cast<std::size_t>(k)]);
    }
  }
}

void note_oddities(const Skeleton& original, PreparedCharacter& out) {
  const std::size_t merged = original.size() - out.joints();
  if (merged > 0) out.notes.push_back(fmt::format("{} joints merged with one at the same place", merged));
  const auto outside = std::count_if(out.skeleton.rest_positions.begin(), out.skeleton.rest_positions.end(),
                                     [&](const Vec3f& p) { return !out.voxels.inside(p); });
  if (outside > 0) out.notes.push_back(fmt::format("{} of {} joints outside the shape", outside, out.joints()));
}

}  // namespace

void derive_inputs(PreparedCharacter& character) {
  character.one_ring = geometry::one_ring(character.mesh);
  character.balls = geometry::geodesic_balls(character.mesh);
  character.voxels = geometry::voxelize(character.mesh);
}

void derive_nearest_bones(PreparedCharacter& character, int most) {
  const std::vector<Bone> all_bones = bones(character.skeleton);
  const std::vector<int> joint_of = starts(all_bones);
  const Matrix distances = geometry::volumetric_geodesic_distance(character.mesh, character.voxels, segments(all_bones), {joint_of, most});
  keep_nearest(geometry::one_bone_per_joint(distances, joint_of), most, character);
}

void derive_from_shape(PreparedCharacter& character, Parts parts) {
  if (parts != Parts::tree) {
    character.one_ring = geometry::one_ring(character.mesh);
    character.balls = geometry::geodesic_balls(character.mesh);
  }
  const std::vector<Vec3f>& joints = character.skeleton.rest_positions.raw();
  if (parts == Parts::joints) character.attention = geometry::attention_labels(character.mesh, joints, parent_indices(character.skeleton));
  const bool reads_voxels = parts == Parts::pairs || parts == Parts::tree || parts == Parts::skin || parts == Parts::bind;
  if (reads_voxels) character.voxels = geometry::voxelize(character.mesh);
  if (parts == Parts::skin || parts == Parts::bind) derive_nearest_bones(character, static_cast<int>(character.nearest_bones.cols()));
}

PerJoint<float> moved_by(const PreparedCharacter& character) {
  PerJoint<float> sums(character.joints(), 0.0f);
  for (VertexId v : character.mesh.positions.ids())
    for (const Influence& i : character.weights[v]) sums[i.joint] += i.weight;
  return sums;
}

void normalise_again(PreparedCharacter& character) {
  const geometry::Normalization again = geometry::normalization_of(character.mesh);
  for (Vec3f& p : character.mesh.positions) p = again.apply(p);
  for (Vec3f& p : character.skeleton.rest_positions) p = again.apply(p);
}

PreparedCharacter prepare(const Rig& rig, CharacterInfo info, const PrepareOptions& options) {
  validate(rig);
  PreparedCharacter out;
  out.info = std::move(info);
  geometry::WorkingMesh working = geometry::make_working_mesh(rig.mesh, options.working_mesh);
  out.mesh = std::move(working.mesh);
  out.normalization = working.normalization;
  derive_inputs(out);

  MergedSkeleton merged = merge_coincident_joints(normalised(rig.skeleton, out.normalization), options.merge_distance);
  out.skeleton = std::move(merged.skeleton);
  const TriangleMesh original = normalised(rig.mesh, out.normalization);
  out.weights = weights_at(out.mesh.positions.raw(), original, rig.weights, merged.from_original);

  const std::vector<Vec3f>& joints = out.skeleton.rest_positions.raw();
  const std::vector<int> parents = parent_indices(out.skeleton);
  out.attention = geometry::attention_labels(out.mesh, joints, parents);
  out.tolerances = PerJoint<float>(geometry::joint_tolerances(out.mesh, joints, parents));
  derive_nearest_bones(out, options.nearest_bones);
  note_oddities(rig.skeleton, out);
  return out;
}

geometry::SkinInputs skin_inputs(const PreparedCharacter& character, int k) {
  const std::vector<Bone> all_bones = bones(character.skeleton);
  const auto bone_count = static_cast<Eigen::Index>(all_bones.size());
  assert(k <= character.nearest_bones.cols() || character.nearest_bones.cols() == bone_count);
  Matrix distances = Matrix::Constant(character.nearest_bones.rows(), bone_count, kFar);
  for (Eigen::Index v = 0; v < distances.rows(); ++v)
    for (Eigen::Index n = 0; n < character.nearest_bones.cols(); ++n)
      distances(v, character.nearest_bones(v, n)) = character.nearest_distances(v, n);
  distances = geometry::one_bone_per_joint(distances, starts(all_bones));
  return geometry::skin_inputs(character.mesh.positions.raw(), segments(all_bones), leaf_flags(all_bones), distances, k);
}

geometry::BoneList bone_list(const Skeleton& skeleton) {
  geometry::BoneList list;
  for (const Bone& bone : bones(skeleton)) {
    list.segments.push_back(bone.segment);
    list.starts.push_back(static_cast<int>(bone.start));
    list.ends.push_back(bone.end ? static_cast<int>(*bone.end) : -1);
  }
  return list;
}

geometry::SkinTargets skin_targets(const PreparedCharacter& character, const geometry::IndexMatrix& nearest) {
  Matrix joint_weights = Matrix::Zero(static_cast<Eigen::Index>(character.vertices()), static_cast<Eigen::Index>(character.joints()));
  for (VertexId v : character.mesh.positions.ids())
    for (const Influence& i : character.weights[v])
      joint_weights(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(i.joint)) = i.weight;
  return geometry::skin_targets(joint_weights, starts(bones(character.skeleton)), nearest);
}

std::vector<std::uint8_t> pair_labels(const Skeleton& skeleton) {
  std::vector<std::uint8_t> labels;
  for (std::size_t i = 0; i < skeleton.size(); ++i)
    for (std::size_t j = i + 1; j < skeleton.size(); ++j)  // parents come before their children
      labels.push_back(skeleton.parents[JointId(static_cast<std::uint16_t>(j))] == JointId(static_cast<std::uint16_t>(i)) ? 1 : 0);
  return labels;
}

std::vector<int> parent_indices(const Skeleton& skeleton) {
  std::vector<int> parents;
  for (const auto& parent : skeleton.parents) parents.push_back(parent ? static_cast<int>(*parent) : -1);
  return parents;
}

}  // namespace osteon::dataset
