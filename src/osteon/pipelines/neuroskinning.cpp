// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/neuroskinning.h"

#include <algorithm>
#include <cmath>

#include "osteon/geometry/neighbourhoods.h"
#include "osteon/infer/rignet.h"
#include "osteon/pipelines/body_frame.h"
#include "osteon/rig/coincident_joints.h"
#include "osteon/skin/islands.h"
#include "osteon/skin/neuro_features.h"
#include "osteon/skin/weight_cleanup.h"

namespace osteon::pipelines {
namespace {

constexpr float kSamePlace = 1e-3f;  // joints nearer than this are one, as in training; longest side 1
constexpr float kPoolReach = 0.25f;  // of the vertices that a graph unit pools
constexpr float kAbsent = -1e4f;

// By names, left is at -x.
bool is_reversed(const Skeleton& skeleton) {
  float left = 0.0f;
  for (JointId j : skeleton.names.ids()) {
    const skin::Side side = skin::bone_name(skeleton.names[j]).side;
    if (side != skin::Side::none) left += (side == skin::Side::left ? 1.0f : -1.0f) * skeleton.rest_positions[j].x();
  }
  return left < 0.0f;
}

// Mesh and skeleton as the networks read them: left at +x, one joint in a place.
struct Body {
  TriangleMesh mesh;
  nets::MeshArrays graph;
  std::vector<Vec3f> normals;
  MergedSkeleton merged;
};

Body study(const TriangleMesh& mesh, const geometry::Neighbourhoods& ring, const Skeleton& skeleton) {
  Eigen::Matrix3f turn = Eigen::Matrix3f::Identity();
  if (is_reversed(skeleton)) turn = Eigen::Vector3f(-1.0f, 1.0f, -1.0f).asDiagonal();
  Body body;
  body.mesh = turned(mesh, turn);
  const geometry::Neighbourhoods none{std::vector<std::uint32_t>(ring.offsets.size(), 0), {}};
  body.graph = infer::single_mesh(body.mesh.positions.raw(), {ring.offsets, ring.members}, {none.offsets, none.members});
  body.normals = vertex_normals(body.mesh).raw();
  body.merged = merge_coincident_joints(turned(skeleton, turn), kSamePlace);
  return body;
}

// Which joints of the original stand for each joint of the merged skeleton.
class Owners {
 public:
  Owners(const Skeleton& original, const MergedSkeleton& merged) : original_(original), merged_(merged), first_(merged.skeleton.size()) {
    for (std::size_t j = original.size(); j-- > 0;) first_[merged.from_original[static_cast<JointId>(j)]] = static_cast<JointId>(j);
  }

  JointId first(JointId joint) const { return first_[joint]; }
  // Of the joints in one place, such as the roots of fingers, the one whose bone it is: the parent of the joint where the bone ends.
  JointId of_bone(const geometry::BoneList& bones, std::size_t bone) const {
    const auto start = static_cast<JointId>(bones.starts[bone]);
    if (bones.ends[bone] < 0) return first_[start];
    const auto parent = original_.parents[first_[static_cast<JointId>(bones.ends[bone])]];
    return parent && merged_.from_original[*parent] == start ? *parent : first_[start];
  }

 private:
  const Skeleton& original_;
  const MergedSkeleton& merged_;
  PerJoint<JointId> first_;
};

// Logits of a network that gave no numbers say nothing.
Matrix finite(Matrix logits, std::vector<std::string>& warnings) {
  if (logits.allFinite()) return logits;
  warnings.push_back("the network gave no numbers: weights follow geometry, or all joints alike, instead");
  return Matrix::Zero(logits.rows(), logits.cols());
}

// Softmax over the joints that each vertex may choose, in the joints of the original, (V,J).
Matrix joint_weights(const NeuroskinningInputs& inputs, const Matrix& logits, float geometric_share) {
  const std::vector<std::int32_t>& offsets = inputs.neuro.choices.offsets;
  const auto vertices = static_cast<Eigen::Index>(offsets.size()) - 1;
  Matrix out = Matrix::Zero(vertices, static_cast<Eigen::Index>(inputs.joints));
  for (Eigen::Index v = 0; v < vertices; ++v) {
    const auto first = static_cast<std::size_t>(offsets[static_cast<std::size_t>(v)]),
               last = static_cast<std::size_t>(offsets[static_cast<std::size_t>(v) + 1]);
    const auto add = [&](float share, float of_network) {
      const auto logit = [&](std::size_t row) { return of_network * logits(static_cast<Eigen::Index>(row), 0) + inputs.log_shares[row]; };
      float largest = logit(first), total = 0.0f;
      for (std::size_t row = first; row < last; ++row) largest = std::max(largest, logit(row));
      for (std::size_t row = first; row < last; ++row) total += std::exp(logit(row) - largest);
      for (std::size_t row = first; row < last; ++row)
        out(v, static_cast<Eigen::Index>(index(inputs.joint_of_row[row]))) += share * std::exp(logit(row) - largest) / total;
    };
    add(1.0f - geometric_share, 1.0f);
    if (geometric_share > 0.0f) add(geometric_share, 0.0f);
  }
  return out;
}

// The same by the paper's network: softmax over the slots that the skeleton has.
Matrix slot_weights(const NeuroskinningInputs& inputs, const Matrix& logits) {
  Matrix out = Matrix::Constant(logits.rows(), static_cast<Eigen::Index>(inputs.joints), kAbsent);
  for (const auto& [joint, slot] : inputs.slots)
    out.col(static_cast<Eigen::Index>(index(joint))) = logits.col(static_cast<Eigen::Index>(slot));
  for (Eigen::Index v = 0; v < out.rows(); ++v) {
    out.row(v) = (out.row(v).array() - out.row(v).maxCoeff()).exp();
    out.row(v) /= out.row(v).sum();
  }
  return out;
}

}  // namespace

geometry::Neighbourhoods neuroskinning_neighbours(const TriangleMesh& mesh) {
  return geometry::geodesic_balls(mesh, kPoolReach, nets::neuro_pooling.back() - 1).members;
}

NeuroskinningInputs neuroskinning_inputs(const TriangleMesh& mesh, const geometry::Neighbourhoods& ring,
                                         const geometry::Neighbourhoods& near, const Skeleton& skeleton,
                                         const infer::NeuroskinningModel& model, const skin::BoneChoiceOptions& options) {
  Body body = study(mesh, ring, skeleton);
  const skin::SuperSkeleton super = skin::SuperSkeleton::from_json(model.super_skeleton());
  const skin::SlotAssignment assignment = super.assign(body.merged.skeleton);
  const Owners owners(skeleton, body.merged);
  const std::vector<Vec3f>& positions = body.mesh.positions.raw();
  NeuroskinningInputs out;
  out.joints = skeleton.size();
  out.neuro.add_nearest(near.offsets, near.members, 0);
  if (model.has_slots()) {
    out.neuro.features = skin::slot_rows(positions, body.normals, body.merged.skeleton, super, assignment, nets::neuro_slots);
    std::vector<bool> taken(super.slots().size(), false);
    for (JointId j : body.merged.skeleton.names.ids())
      if (const std::size_t slot = assignment.slot[j]; !taken[slot]) {
        out.slots.emplace_back(owners.first(j), slot);
        taken[slot] = true;
      }
  } else {
    const skin::BoneChoices choices = skin::bone_choices(body.mesh, body.merged.skeleton, options);
    const skin::ChoiceRows rows =
        skin::choice_rows(positions, body.normals, body.merged.skeleton, choices, super, assignment, nets::neuro_kinds);
    out.neuro.choices.add(rows.features, rows.offsets, rows.joints);
    out.neuro.joints = rows.joint_features;
    out.log_shares = rows.log_shares;
    for (Eigen::Index v = 0; v + 1 < static_cast<Eigen::Index>(rows.offsets.size()); ++v)
      for (std::int32_t k = 0; k < rows.offsets[static_cast<std::size_t>(v) + 1] - rows.offsets[static_cast<std::size_t>(v)]; ++k)
        out.joint_of_row.push_back(owners.of_bone(choices.bones, static_cast<std::size_t>(choices.nearest(v, k))));
  }
  out.graph = std::move(body.graph);
  return out;
}

Matrix neuroskinning_rows(const NeuroskinningInputs& inputs, const infer::NeuroskinningModel& model, float geometric_share,
                          std::vector<std::string>& warnings) {
  const Matrix logits = finite(model(inputs.graph, inputs.neuro), warnings);
  return model.has_slots() ? slot_weights(inputs, logits) : joint_weights(inputs, logits, geometric_share);
}

NeuroskinningResult neuroskinning_weights(const TriangleMesh& mesh, const Skeleton& skeleton, const infer::NeuroskinningModel& model,
                                          const NeuroskinningOptions& options) {
  NeuroskinningResult result;
  const Eigen::Matrix3f turn = body_frame(mesh, Up::automatic).turn;
  const geometry::WorkingMesh working = geometry::make_working_mesh(turned(mesh, turn), options.working_mesh);
  const geometry::Neighbourhoods ring = geometry::one_ring(working.mesh);
  result.repairs = working.clean.repairs;
  Skeleton placed = turned(skeleton, turn);
  for (Vec3f& p : placed.rest_positions) p = working.normalization.apply(p);
  const NeuroskinningInputs inputs =
      neuroskinning_inputs(working.mesh, ring, neuroskinning_neighbours(working.mesh), placed, model, options.choices);
  Matrix weights = neuroskinning_rows(inputs, model, options.geometric_share, result.warnings);
  for (int round = 0; round < options.smooth; ++round) weights = skin::smooth_rows(weights, ring);
  skin::prune_rows(weights, options.prune_share, options.max_influences);
  skin::fill_empty_rows(weights, working.mesh.positions, ring);
  result.weights = skin::weights_on_original(weights, geometry::carry_back(working), options.max_influences);
  result.weights = skin::evened(result.weights, working.clean, options.max_influences);
  if (options.rigid_islands) result.rigid_islands = skin::make_islands_rigid(result.weights, working.clean, turned(skeleton, turn));
  return result;
}

}  // namespace osteon::pipelines
