// SPDX-License-Identifier: Apache-2.0
#include "osteon/rig/skeleton.h"

#include <cmath>
#include <queue>
#include <unordered_set>

#include "osteon/base/error.h"

namespace osteon {
namespace {

constexpr float kOpposed = 0.05f;  // ways to children that cancel each other to this share of their length

// A frame whose +y is `direction` and whose +z is as near to world +z as possible (to world -y where the bone runs along z).
Quatf along(const Vec3f& direction) {
  const Vec3f y = direction.normalized();
  const Vec3f reference = std::abs(y.z()) < 0.99f ? Vec3f::UnitZ() : Vec3f(0, -1, 0);
  const Vec3f x = y.cross(reference).normalized();
  Eigen::Matrix3f axes;
  axes << x, y, x.cross(y);
  return Quatf(axes).normalized();
}

PerJoint<int> descendant_counts(const Skeleton& skeleton) {
  PerJoint<int> counts(skeleton.size(), 0);
  for (std::size_t i = skeleton.size(); i-- > 1;) {  // children come after their parents
    const auto joint = static_cast<JointId>(i);
    counts[*skeleton.parents[joint]] += counts[joint] + 1;
  }
  return counts;
}

}  // namespace

JointId Skeleton::add(std::string name, std::optional<JointId> parent, const Vec3f& position, const Quatf& orientation) {
  names.push_back(std::move(name));
  parents.push_back(parent);
  rest_orientations.push_back(orientation);
  return rest_positions.push_back(position);
}

void validate(const Skeleton& skeleton) {
  const std::size_t n = skeleton.size();
  if (n == 0) throw Error("skeleton has no joints");
  if (n > 65535) throw Error("skeleton has {} joints; at most 65535 are supported", n);
  if (skeleton.parents.size() != n || skeleton.rest_positions.size() != n || skeleton.rest_orientations.size() != n)
    throw Error("skeleton has {} names, {} parents, {} positions and {} orientations; expected equally many", n, skeleton.parents.size(),
                skeleton.rest_positions.size(), skeleton.rest_orientations.size());
  std::unordered_set<std::string> seen;
  for (JointId j : skeleton.names.ids()) {
    const std::string& name = skeleton.names[j];
    if (name.empty()) throw Error("joint {} has no name", index(j));
    if (!seen.insert(name).second) throw Error("joint {} has the name '{}' of an earlier joint", index(j), name);
    const auto parent = skeleton.parents[j];
    if (!parent && index(j) != 0) throw Error("joint {} ('{}') is a second root", index(j), name);
    if (parent && *parent >= j)
      throw Error("joint {} ('{}') has parent {}; parents come before their children", index(j), name, index(*parent));
    if (!skeleton.rest_positions[j].allFinite()) throw Error("joint {} ('{}') has no finite rest position", index(j), name);
    const float norm = skeleton.rest_orientations[j].norm();
    if (!(std::abs(norm - 1.0f) < 1e-3f)) throw Error("joint {} ('{}') has an orientation of length {}; expected 1", index(j), name, norm);
  }
}

PerJoint<std::vector<JointId>> children(const Skeleton& skeleton) {
  PerJoint<std::vector<JointId>> out(skeleton.size());
  for (JointId j : skeleton.names.ids())
    if (skeleton.parents[j]) out[*skeleton.parents[j]].push_back(j);
  return out;
}

void orient_along_bones(Skeleton& skeleton) {
  const auto kids = children(skeleton);
  const auto counts = descendant_counts(skeleton);
  for (JointId j : skeleton.names.ids()) {
    const Quatf inherited = skeleton.parents[j] ? skeleton.rest_orientations[*skeleton.parents[j]] : Quatf::Identity();
    Vec3f way = Vec3f::Zero();
    float length = 0.0f;
    int most = -1;
    for (JointId kid : kids[j]) {
      const Vec3f to_kid = skeleton.rest_positions[kid] - skeleton.rest_positions[j];
      if (!(to_kid.norm() > 1e-6f) || counts[kid] < most) continue;
      if (counts[kid] > most) {
        way.setZero();
        length = 0.0f;
      }
      most = counts[kid];
      way += to_kid;
      length += to_kid.norm();
    }
    skeleton.rest_orientations[j] = way.norm() > kOpposed * length ? along(way) : inherited;
  }
}

Skeleton turned(Skeleton skeleton, const Eigen::Matrix3f& rotation) {
  const Quatf turn(rotation);
  for (Vec3f& p : skeleton.rest_positions) p = rotation * p;
  for (Quatf& q : skeleton.rest_orientations) q = (turn * q).normalized();
  return skeleton;
}

Skeleton transformed(Skeleton skeleton, const Eigen::Affine3d& similarity) {
  if (similarity.matrix().isIdentity(0.0)) return skeleton;
  const Eigen::Quaterniond turn(similarity.rotation());
  for (Vec3f& p : skeleton.rest_positions) p = (similarity * p.cast<double>()).cast<float>();
  for (Quatf& q : skeleton.rest_orientations) q = (turn * q.cast<double>()).normalized().cast<float>().normalized();
  return skeleton;
}

std::vector<Bone> bones(const Skeleton& skeleton) {
  const auto kids = children(skeleton);
  const auto& at = skeleton.rest_positions;
  std::vector<Bone> out;
  std::queue<JointId> open;
  open.push(JointId{0});
  if (kids[JointId{0}].empty()) out.push_back({JointId{0}, std::nullopt, {at[JointId{0}], at[JointId{0}]}});
  while (!open.empty()) {
    const JointId j = open.front();
    open.pop();
    for (JointId kid : kids[j]) {
      out.push_back({j, kid, {at[j], at[kid]}});
      if (kids[kid].empty()) out.push_back({kid, std::nullopt, {at[kid], at[kid]}});
      open.push(kid);
    }
  }
  return out;
}

}  // namespace osteon
