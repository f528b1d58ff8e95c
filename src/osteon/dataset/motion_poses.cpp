// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/motion_poses.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "osteon/dataset/retarget.h"

namespace osteon::dataset {
namespace {

constexpr std::size_t kCandidates = 64;             // poses that are looked at
constexpr float kUpright = 0.7f;                    // cosine of the largest tilt of the whole body: 45 degrees
constexpr float kSmallest = 0.2f, kLargest = 4.0f;  // of a part's size

// The rotation nearest to the mean of all parts' turns: how the body as a whole is turned.
Eigen::Matrix3f whole_turn(const Articulation& pose, const PerJoint<float>& moved) {
  Eigen::Matrix3f sum = Eigen::Matrix3f::Zero();
  for (JointId j : moved.ids()) sum += moved[j] * pose.linear[j];
  const Eigen::JacobiSVD<Eigen::Matrix3f> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3f u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0f) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

bool is_usable(const Articulation& pose) {
  return std::ranges::all_of(pose.linear, [](const Eigen::Matrix3f& m) {
    const float size = std::cbrt(m.determinant());
    return size > kSmallest && size < kLargest && m.allFinite();
  });
}

// Facing as in the rest pose; empty where the body does not stand.
std::optional<Articulation> standing(Articulation pose, const PerJoint<float>& moved) {
  if (!is_usable(pose)) return std::nullopt;
  const Eigen::Matrix3f turn = whole_turn(pose, moved);
  if (turn(1, 1) < kUpright) return std::nullopt;
  const float yaw = std::atan2(turn(0, 2) - turn(2, 0), turn(0, 0) + turn(2, 2));  // of the nearest turn about y
  const Eigen::Matrix3f back = Eigen::AngleAxisf(-yaw, Vec3f::UnitY()).toRotationMatrix();
  for (Eigen::Matrix3f& m : pose.linear) m = back * m;
  for (Vec3f& p : pose.joints) p = back * p;
  return pose;
}

float squared_distance(const Articulation& a, const Articulation& b, const PerJoint<float>& moved) {
  float sum = 0.0f;
  for (JointId j : moved.ids()) sum += moved[j] * (a.linear[j] - b.linear[j]).squaredNorm();
  return sum;
}

std::vector<Articulation> farthest(std::vector<Articulation> all, const Articulation& first, const PerJoint<float>& moved,
                                   std::size_t count) {
  std::vector<float> distance(all.size(), std::numeric_limits<float>::infinity());
  std::vector<Articulation> chosen{first};
  while (chosen.size() <= count) {
    for (std::size_t i = 0; i < all.size(); ++i) distance[i] = std::min(distance[i], squared_distance(all[i], chosen.back(), moved));
    const auto next = std::ranges::max_element(distance);
    if (next == distance.end() || *next <= 0.0f) break;
    chosen.push_back(all[static_cast<std::size_t>(next - distance.begin())]);
  }
  chosen.erase(chosen.begin());
  return chosen;
}

// A motion and the number of one of its poses, all alike likely. Pre: there are poses.
std::pair<const Motion*, std::size_t> draw(const std::vector<Motion>& motions, Random& random) {
  std::size_t poses = 0;
  for (const Motion& m : motions) poses += m.poses.size();
  std::size_t at = random.below(poses);
  const Motion* motion = motions.data();
  for (; at >= motion->poses.size(); ++motion) at -= motion->poses.size();
  return {motion, at};
}

std::vector<Articulation> candidates(const PreparedCharacter& character, const MotionLibrary& library, Random& random) {
  std::vector<Articulation> out;
  if (const auto own = library.own.find(character.info.id); own != library.own.end()) {
    std::vector<std::size_t> order(own->second.poses.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    random.shuffle<std::size_t>(order);
    order.resize(std::min(order.size(), kCandidates));
    for (const std::size_t i : order) out.push_back(own_pose(character, own->second, i));
    return out;
  }
  if (library.bipeds.empty() || !biped_joints(character.skeleton)[0]) return out;
  for (std::size_t i = 0; i < kCandidates; ++i) {
    const auto [motion, pose] = draw(library.bipeds, random);
    if (auto retargeted_pose = retargeted(character.skeleton, *motion, pose)) out.push_back(std::move(*retargeted_pose));
  }
  return out;
}

}  // namespace

Articulation own_pose(const PreparedCharacter& character, const Motion& motion, std::size_t pose) {
  const Skeleton& skeleton = character.skeleton;
  Articulation out{PerJoint<Eigen::Matrix3f>(skeleton.size(), Eigen::Matrix3f::Identity()), skeleton.rest_positions};
  for (JointId j : skeleton.names.ids()) {
    const Vec3f& rest = skeleton.rest_positions[j];
    const auto parent = skeleton.parents[j];
    const auto found = std::ranges::find(motion.names, skeleton.names[j]);
    if (found != motion.names.end()) {
      const auto i = static_cast<std::size_t>(found - motion.names.begin());
      const Transform moves = motion.poses[pose][i] * motion.rest[i].inverse();
      out.linear[j] = moves.linear();
      out.joints[j] = character.normalization.apply(moves * character.normalization.undo(rest));
    } else if (parent) {
      out.linear[j] = out.linear[*parent];
      out.joints[j] = out.joints[*parent] + out.linear[*parent] * (rest - skeleton.rest_positions[*parent]);
    }
  }
  return out;
}

std::vector<Articulation> motion_poses(const PreparedCharacter& character, const MotionLibrary& library, std::size_t count,
                                       Random& random) {
  const PerJoint<float> moved = moved_by(character);
  std::vector<Articulation> usable;
  for (Articulation& pose : candidates(character, library, random))
    if (auto upright = standing(std::move(pose), moved)) usable.push_back(std::move(*upright));
  const Articulation rest{PerJoint<Eigen::Matrix3f>(character.joints(), Eigen::Matrix3f::Identity()), character.skeleton.rest_positions};
  return farthest(std::move(usable), rest, moved, count);
}

}  // namespace osteon::dataset
