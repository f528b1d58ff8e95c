// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "osteon/base/types.h"

namespace osteon::pipelines {

// A rigid frame in which a symmetry plane is x = 0, so that mirroring is a change of sign: exact, and the same for any plane.
struct MirrorFrame {
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
  float offset = 0.0f;

  // Turns the normal to +x by the smallest angle; of the two normals the one whose largest coordinate is positive, so that +x stays left.
  static MirrorFrame of(const Plane& plane);
  Vec3f to(const Vec3f& p) const { return rotation * p - Vec3f(offset, 0, 0); }
  Vec3f from(const Vec3f& p) const { return rotation.transpose() * (p + Vec3f(offset, 0, 0)); }
};

inline Vec3f mirrored(const Vec3f& p) { return {-p.x(), p.y(), p.z()}; }

// Joints before they are connected. Partners i and j: positions[j] == mirrored(positions[i]), bit by bit, and they follow one another,
// left (x > 0) first. A joint on the plane (x == 0) is its own partner. Without symmetry nobody has a partner.
struct JointSet {
  MirrorFrame frame;                                // normalised frame -> frame of the positions
  std::vector<Vec3f> positions;                     // (J) in `frame`
  std::vector<std::optional<std::size_t>> partner;  // (J)

  std::size_t size() const { return positions.size(); }
  std::vector<Vec3f> normalised() const {  // (J) in the frame of the networks
    std::vector<Vec3f> out;
    for (const Vec3f& p : positions) out.push_back(frame.from(p));
    return out;
  }
};

// Joints that come from elsewhere, in the frame of the networks, and are kept as they are. Partners are those that are nearest to one
// another's mirror image, and not farther from it than `tolerance`: only nearly mirror images, and in any order.
JointSet joint_set_of(std::span<const Vec3f> positions, const std::optional<Plane>& symmetry, float tolerance = 0.01f);

}  // namespace osteon::pipelines
