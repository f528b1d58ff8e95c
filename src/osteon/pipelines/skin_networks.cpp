// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skin_networks.h"

#include <algorithm>

#include "osteon/geometry/rignet_features.h"
#include "osteon/geometry/volumetric_geodesic.h"
#include "osteon/pipelines/neuroskinning.h"
#include "osteon/pipelines/skin_prediction.h"
#include "osteon/skin/distance_weights.h"

namespace osteon::pipelines {
namespace {

constexpr float kGeometricShare = 0.5f;  // in NeuroSkinning's part of the weights: a quarter of all
// Where so many joints have fewer vertices of the working mesh to themselves, the skin is found on a finer one: on training and validation
// characters that have (all with fingers) L1 falls by a tenth to a third, with as many joints elsewhere it does not.
constexpr std::size_t kManyJoints = 20, kFewVertices = 4;

// What the binding network reads of every vertex and the bones near it.
nets::BindArrays choices_of(const Body& body, const geometry::BoneList& bones, const geometry::IndexMatrix& nearest,
                            const Matrix& distances) {
  Matrix of_nearest = Matrix::Zero(nearest.rows(), nearest.cols());
  for (Eigen::Index v = 0; v < nearest.rows(); ++v)
    for (Eigen::Index k = 0; k < nearest.cols(); ++k)
      if (nearest(v, k) >= 0) of_nearest(v, k) = distances(v, nearest(v, k));
  const PerVertex<Vec3f> normals = vertex_normals(body.working.mesh);
  const geometry::BindInputs inputs = geometry::bind_inputs(body.positions(), normals.raw(), bones, nearest, of_nearest);
  nets::BindArrays choices;
  choices.add(inputs.features, inputs.offsets, inputs.bones);
  return choices;
}

Matrix predict_weights(const std::vector<Bone>& bones, std::size_t joints, const Matrix& distances, const Body& body,
                       const infer::RignetModels& models, const Ablation& ablation, std::vector<std::string>& warnings) {
  if (joints == 1) return Matrix::Ones(distances.rows(), 1);
  std::vector<Segment> segments;
  std::vector<std::uint8_t> leaf;
  std::vector<int> starts, ends;
  for (const Bone& b : bones) {
    segments.push_back(b.segment);
    leaf.push_back(b.end ? 0 : 1);
    starts.push_back(static_cast<int>(b.start));
    ends.push_back(b.end ? static_cast<int>(*b.end) : -1);
  }
  const Matrix choice = geometry::one_bone_per_joint(distances, starts);
  geometry::IndexMatrix nearest = geometry::nearest_bones(choice, ablation.bones);
  Matrix weights;
  if (models.binds()) {
    weights = models.bind_weights(body.graph, choices_of(body, {segments, starts, ends}, nearest, choice), ablation.bones);
  } else {
    const geometry::SkinInputs inputs = geometry::skin_inputs(body.positions(), segments, leaf, choice);
    weights = models.skin_weights(body.graph, inputs.features, inputs.nearest);
    nearest = inputs.nearest;
  }
  if (weights.allFinite()) return joint_weights(weights, nearest, bones, joints);
  warnings.push_back("the skin network gave no numbers: weights fall off with the distance to the bones instead");
  return skin::distance_weights(distances, bones, joints);
}

// The binding network's weights and NeuroSkinning's (its own, with geodesic voxel binding in it): they learned the same from different
// evidence, and err in different places.
Matrix heard_beside(const Matrix& raw, const infer::NeuroskinningModel& second, const Skeleton& skeleton, const Body& body, float share,
                    Stages& stages, std::vector<std::string>& warnings) {
  Skeleton placed = skeleton;
  for (Vec3f& p : placed.rest_positions) p = body.working.normalization.apply(p);
  const TriangleMesh& mesh = body.working.mesh;
  const auto near = stages.run("wide neighbourhoods", [&] { return neuroskinning_neighbours(mesh); });
  const auto inputs = stages.run("joint choices", [&] { return neuroskinning_inputs(mesh, body.ring, near, placed, second); });
  return stages.run("second network",
                    [&]() -> Matrix { return pooled(raw, neuroskinning_rows(inputs, second, kGeometricShare, warnings), share); });
}

}  // namespace

std::vector<Bone> normalised_bones(const Skeleton& skeleton, const geometry::Normalization& normalization) {
  std::vector<Bone> list = bones(skeleton);
  for (Bone& b : list) b.segment = {normalization.apply(b.segment.a), normalization.apply(b.segment.b)};
  return list;
}

Matrix distances_to(const std::vector<Bone>& bones, const Body& body, const Ablation& ablation) {
  std::vector<Segment> segments;
  std::vector<int> starts;
  for (const Bone& b : bones) {
    segments.push_back(b.segment);
    starts.push_back(static_cast<int>(b.start));
  }
  if (!ablation.geodesic) return geometry::straight_distance(body.working.mesh, segments);
  const int count = std::max(ablation.bones, geometry::kSkinBones);
  return geometry::volumetric_geodesic_distance(body.working.mesh, body.voxels, segments, {starts, count});
}

bool is_too_coarse(const std::vector<Bone>& bones, std::size_t joints, const Body& body, const geometry::WorkingMeshOptions& options) {
  if (options.target_vertices >= kFineVertices) return false;
  if (joints < kManyJoints || body.working.clean.mesh.positions.size() <= body.positions().size()) return false;
  std::vector<Segment> segments;
  for (const Bone& b : bones) segments.push_back(b.segment);
  const Matrix distances = geometry::straight_distance(body.working.mesh, segments);
  std::vector<std::size_t> vertices(joints, 0);
  for (Eigen::Index v = 0; v < distances.rows(); ++v) {
    Eigen::Index nearest = 0;
    distances.row(v).minCoeff(&nearest);
    ++vertices[index(bones[static_cast<std::size_t>(nearest)].start)];
  }
  return std::ranges::count_if(vertices, [](std::size_t n) { return n < kFewVertices; }) >= static_cast<std::ptrdiff_t>(kManyJoints);
}

NetworkWeights network_weights(const Skeleton& skeleton, const std::vector<Bone>& bones, const Matrix& distances, const Body& body,
                               const infer::RignetModels& models, const Ablation& ablation, Stages& stages,
                               std::vector<std::string>& warnings) {
  Matrix rows =
      stages.run("skin network", [&] { return predict_weights(bones, skeleton.size(), distances, body, models, ablation, warnings); });
  const auto* second = models.neuroskinning();
  if (!second || !(ablation.neuroskinning > 0.0f) || skeleton.size() == 1) return {std::move(rows), false};
  return {heard_beside(rows, *second, skeleton, body, ablation.neuroskinning, stages, warnings), true};
}

}  // namespace osteon::pipelines
