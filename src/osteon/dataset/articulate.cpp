// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/articulate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "osteon/skin/linear_blend.h"

namespace osteon::dataset {
namespace {

constexpr float kPartnerReach = 0.01f;  // a mirror partner stands this near to the image; longest side = 1
constexpr float kKeptSize = 0.7f;       // share of the logarithm of a part's size that its children keep
constexpr float kLongBone = 0.15f;      // bones of this length and more bend in full
constexpr float kLeastBend = 0.3f;      // share of the bend that the joints of the shortest bones get

using PerJointRotation = PerJoint<Eigen::Matrix3f>;

Vec3f random_direction(Random& random) {
  const float z = random.uniform(-1.0f, 1.0f), angle = random.uniform(0.0f, 2.0f * std::numbers::pi_v<float>);
  const float r = std::sqrt(1.0f - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

// How much of a bend a joint gets: chains of many short bones would curl up.
PerJoint<float> bend_shares(const Skeleton& skeleton) {
  PerJoint<float> longest(skeleton.size(), 0.0f);
  for (JointId j : skeleton.names.ids())
    if (const auto parent = skeleton.parents[j]) {
      const float length = (skeleton.rest_positions[j] - skeleton.rest_positions[*parent]).norm();
      longest[*parent] = std::max(longest[*parent], length);
      longest[j] = std::max(longest[j], length);
    }
  for (float& share : longest) share = std::clamp(share / kLongBone, kLeastBend, 1.0f);
  return longest;
}

// A rotation as its mirror image in the plane makes it.
Eigen::Matrix3f mirrored(const Eigen::Matrix3f& rotation, const Plane& plane) {
  const Eigen::Matrix3f mirror = Eigen::Matrix3f::Identity() - 2.0f * plane.normal * plane.normal.transpose();
  return mirror * rotation * mirror;
}

// A rotation times a size, without the size.
Eigen::Matrix3f rotation_of(const Eigen::Matrix3f& linear) { return linear / std::cbrt(linear.determinant()); }

}  // namespace

PerJoint<std::optional<JointId>> mirror_partners(const Skeleton& skeleton, const std::optional<Plane>& symmetry) {
  PerJoint<std::optional<JointId>> partners(skeleton.size());
  if (!symmetry) return partners;
  const auto nearest = [&](const Vec3f& p) {
    const auto& all = skeleton.rest_positions;
    const auto best = std::ranges::min_element(all, {}, [&](const Vec3f& q) { return (q - p).squaredNorm(); });
    return static_cast<JointId>(best - all.begin());
  };
  for (JointId j : skeleton.names.ids()) {
    const Vec3f image = symmetry->mirror(skeleton.rest_positions[j]);
    const JointId there = nearest(image);
    const bool back = nearest(symmetry->mirror(skeleton.rest_positions[there])) == j;
    if (back && (skeleton.rest_positions[there] - image).norm() < kPartnerReach) partners[j] = there;
  }
  return partners;
}

Articulation random_articulation(const Skeleton& skeleton, const std::optional<Plane>& symmetry, const ArticulateOptions& options,
                                 Random& random) {
  const bool alike = random.uniform() < options.symmetric;
  const auto partners = mirror_partners(skeleton, alike ? symmetry : std::nullopt);
  const PerJoint<float> bends = bend_shares(skeleton);
  const float bend = random.uniform(0.0f, options.largest_bend);

  // Each joint's own turn and size, and what has come together on the way from the root.
  PerJointRotation turn(skeleton.size(), Eigen::Matrix3f::Identity()), rotation = turn;
  PerJoint<float> own(skeleton.size(), 0.0f), log_size = own;
  Articulation out{PerJointRotation(skeleton.size()), PerJoint<Vec3f>(skeleton.size())};
  for (JointId j : skeleton.names.ids()) {
    const auto parent = skeleton.parents[j];
    const auto partner = partners[j];
    if (partner && *partner < j) {
      turn[j] = mirrored(turn[*partner], *symmetry);
      own[j] = own[*partner];
    } else if (parent) {
      const Vec3f axis = partner == j ? symmetry->normal : random_direction(random);  // on the plane: nods only
      turn[j] = Eigen::AngleAxisf(bend * bends[j] * std::clamp(random.normal(), -2.5f, 2.5f), axis).toRotationMatrix();
      own[j] = options.proportion * std::clamp(random.normal(), -2.5f, 2.5f);
    }
    rotation[j] = parent ? Eigen::Matrix3f(rotation[*parent] * turn[j]) : turn[j];
    log_size[j] = own[j] + (parent ? kKeptSize * log_size[*parent] : 0.0f);
    out.linear[j] = std::exp(log_size[j]) * rotation[j];
    const Vec3f& rest = skeleton.rest_positions[j];
    out.joints[j] = parent ? Vec3f(out.joints[*parent] + out.linear[*parent] * (rest - skeleton.rest_positions[*parent])) : rest;
  }
  return out;
}

Articulation with_sizes(const Articulation& pose, const Articulation& sizes, const Skeleton& skeleton) {
  Articulation out = pose;
  for (JointId j : skeleton.names.ids()) {
    out.linear[j] *= std::cbrt(sizes.linear[j].determinant());
    if (const auto parent = skeleton.parents[j])
      out.joints[j] = out.joints[*parent] + std::cbrt(sizes.linear[*parent].determinant()) * (pose.joints[j] - pose.joints[*parent]);
  }
  return out;
}

PreparedCharacter articulated(const PreparedCharacter& character, const Articulation& articulation) {
  PreparedCharacter out = character;
  PerJoint<Transform> transforms;
  for (JointId j : character.skeleton.names.ids()) {
    Transform t = Transform::Identity();
    t.linear() = articulation.linear[j];
    t.translation() = articulation.joints[j] - articulation.linear[j] * character.skeleton.rest_positions[j];
    transforms.push_back(t);
  }
  out.mesh.positions = skin::skin(character.mesh.positions, character.weights, transforms);
  out.skeleton.rest_positions = articulation.joints;
  for (JointId j : out.skeleton.names.ids())
    out.skeleton.rest_orientations[j] = Quatf(rotation_of(articulation.linear[j])) * character.skeleton.rest_orientations[j];
  out.poses.clear();
  normalise_again(out);
  return out;
}

}  // namespace osteon::dataset
