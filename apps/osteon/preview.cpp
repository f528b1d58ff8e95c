// SPDX-License-Identifier: Apache-2.0
#include "preview.h"

#include <charconv>

#include "osteon/base/error.h"
#include "osteon/base/random.h"
#include "osteon/skin/linear_blend.h"

namespace osteon::app {

Pose lively_pose(const Skeleton& skeleton, std::uint64_t seed) {
  Random random(seed);
  Pose pose = Pose::rest(skeleton);
  for (const JointId j : skeleton.names.ids()) {
    const Vec3f turn = 0.13f * Vec3f(random.normal(), random.normal(), random.normal());  // radians about each axis
    if (skeleton.parents[j] && turn.norm() > 0) pose.rotations[j] = Quatf(Eigen::AngleAxisf(turn.norm(), turn.normalized()));
  }
  return pose;
}

std::optional<std::uint64_t> parse_pose(const std::string& text) {
  if (text == "none") return std::nullopt;
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size()) throw Error("--pose: found '{}', expected a number or 'none'", text);
  return seed;
}

void save_preview(const std::filesystem::path& path, const TriangleMesh& mesh, const Skeleton* skeleton, const SkinWeights* weights,
                  std::optional<std::uint64_t> pose_seed, const render::PictureOptions& options) {
  std::optional<render::Posed> posed;
  if (skeleton && weights && pose_seed) {
    const Pose pose = lively_pose(*skeleton, *pose_seed);
    posed = render::Posed{skin::skin(mesh.positions, *weights, skinning_transforms(*skeleton, pose)), posed_positions(*skeleton, pose)};
  }
  render::save_png(path, render::character_picture({mesh, skeleton, weights, posed ? &*posed : nullptr}, options));
}

}  // namespace osteon::app
