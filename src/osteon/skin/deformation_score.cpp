// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/deformation_score.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "osteon/base/parallel.h"
#include "osteon/skin/linear_blend.h"

namespace osteon::skin {
namespace {

constexpr float kMoved = 1e-3f;  // weight below the joint that counts as moved, and 1 minus that

// How much of every vertex follows a joint or one below it: (J) bit sets would be large, so one joint at a time.
PerVertex<float> share_below(const Rig& rig, JointId joint) {
  PerJoint<bool> below(rig.skeleton.size(), false);
  for (JointId j : rig.skeleton.names.ids()) below[j] = j == joint || (rig.skeleton.parents[j] && below[*rig.skeleton.parents[j]]);
  PerVertex<float> out(rig.mesh.positions.size(), 0.0f);
  for (VertexId v : rig.mesh.positions.ids())
    for (const Influence& i : rig.weights[v])
      if (below[i.joint]) out[v] += i.weight;
  return out;
}

// The faces that bend: whose corners do not all move with the joint alike.
std::vector<FaceId> bending_faces(const Rig& rig, const PerVertex<float>& share) {
  std::vector<FaceId> out;
  for (FaceId f : rig.mesh.faces.ids()) {
    const auto& [a, b, c] = rig.mesh.faces[f];
    const auto [low, high] = std::minmax({share[a], share[b], share[c]});
    if (high > kMoved && low < 1.0f - kMoved && (high - low > kMoved || (low > kMoved && high < 1.0f - kMoved))) out.push_back(f);
  }
  return out;
}

double volume(const TriangleMesh& mesh, const PerVertex<Vec3f>& at) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.faces) sum += at[a].cast<double>().dot(at[b].cast<double>().cross(at[c].cast<double>()));
  return sum / 6.0;
}

double log_ratio(double after, double before, double least) { return std::abs(std::log(std::max(after, least) / std::max(before, least))); }

void add_faces(const Rig& rig, const std::vector<FaceId>& faces, const PerVertex<Vec3f>& posed, const PerVertex<float>& share,
               const Quatf& turn, double size, Deformation& sum) {
  const double least = 1e-5 * size;
  for (const FaceId f : faces) {
    const Triangle& t = rig.mesh.faces[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = t[k], b = t[(k + 1) % 3];
      sum.stretch += log_ratio(static_cast<double>((posed[a] - posed[b]).norm()),
                               static_cast<double>((rig.mesh.positions[a] - rig.mesh.positions[b]).norm()), least) /
                     3.0;
    }
    const Vec3f before = area_vector(rig.mesh, f), after = (posed[t[1]] - posed[t[0]]).cross(posed[t[2]] - posed[t[0]]);
    sum.area += log_ratio(static_cast<double>(after.norm()), static_cast<double>(before.norm()), least * least);
    const float part = (share[t[0]] + share[t[1]] + share[t[2]]) / 3.0f;
    sum.flips += (Quatf::Identity().slerp(part, turn) * before).dot(after) < 0.0f;
  }
}

Deformation bent(const Rig& rig, JointId joint, const std::vector<FaceId>& faces, const PerVertex<float>& share,
                 const SweepOptions& options) {
  Deformation sum;
  const double size = static_cast<double>(bounds(rig.mesh).sizes().maxCoeff()), whole = volume(rig.mesh, rig.mesh.positions);
  const double box = static_cast<double>(bounds(rig.mesh).volume());
  constexpr int kPoses = 3;
  for (int axis = 0; axis < kPoses; ++axis) {
    Pose pose = Pose::rest(rig.skeleton);
    const Vec3f about = rig.skeleton.rest_orientations[joint] * Vec3f::Unit(axis);
    pose.rotations[joint] = Quatf(Eigen::AngleAxisf(options.angle, about));
    const PerVertex<Vec3f> posed = skin(rig.mesh.positions, rig.weights, skinning_transforms(rig.skeleton, pose));
    add_faces(rig, faces, posed, share, pose.rotations[joint], size, sum);
    if (whole > 1e-4 * box) sum.volume_loss += std::max(0.0, 1.0 - volume(rig.mesh, posed) / whole) / kPoses;
  }
  const double count = static_cast<double>(kPoses * faces.size());
  sum.stretch /= count;
  sum.area /= count;
  sum.flips /= count;
  return sum;
}

}  // namespace

DeformationScore deformation_score(const Rig& rig, const SweepOptions& options) {
  std::vector<std::optional<Deformation>> scores(rig.skeleton.size());
  parallel_for(scores.size(), 1, [&](std::size_t j, std::size_t) {
    const auto joint = static_cast<JointId>(j);
    if (!rig.skeleton.parents[joint]) return;
    const PerVertex<float> share = share_below(rig, joint);
    const std::vector<FaceId> faces = bending_faces(rig, share);
    if (!faces.empty()) scores[j] = bent(rig, joint, faces, share, options);
  });
  DeformationScore out;
  for (std::size_t j = 0; j < scores.size(); ++j)
    if (scores[j]) out.joints.push_back({static_cast<JointId>(j), *scores[j]});
  for (const auto& [joint, score] : out.joints) {
    const double share = 1.0 / static_cast<double>(out.joints.size());
    out.mean.stretch += share * score.stretch;
    out.mean.area += share * score.area;
    out.mean.flips += share * score.flips;
    out.mean.volume_loss += share * score.volume_loss;
  }
  std::ranges::stable_sort(out.joints, std::greater(), [](const JointDeformation& j) { return j.score.stretch; });
  return out;
}

}  // namespace osteon::skin
