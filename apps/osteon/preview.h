// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "osteon/render/picture.h"
#include "osteon/rig/pose.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

namespace osteon::app {

// A pose that shows how a character bends: each joint but the root is turned a little about a random axis. The same seed, the same pose.
Pose lively_pose(const Skeleton& skeleton, std::uint64_t seed);

// What `--pose` says: a seed, or "none" for the rest pose alone.
std::optional<std::uint64_t> parse_pose(const std::string& text);

// Draws what there is of the character (skeleton and weights may be null) into a PNG, with the lively pose if a seed is given.
void save_preview(const std::filesystem::path& path, const TriangleMesh& mesh, const Skeleton* skeleton, const SkinWeights* weights,
                  std::optional<std::uint64_t> pose_seed, const render::PictureOptions& options = {});

}  // namespace osteon::app
