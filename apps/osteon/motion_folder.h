// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "osteon/dataset/manifest.h"
#include "osteon/dataset/motion_poses.h"

namespace osteon::app {

struct MotionFolder {
  dataset::MotionLibrary library;
  std::string sources;  // of the clips that were read: a JSON list of {licence, author, source, clips (how many)}
};

// Clips of a folder with a manifest.jsonl (docs/training.md says its keys), thinned to a few poses a second: GLB of the characters
// themselves, those of `wanted` alone, and BVH of bipeds, whose joint_map.json says which joints are which; may be compressed (gzip). Clips
// whose rig is a character of `all` that is not `wanted` are not looked at: nothing is learned from held out characters.
// Throws Error naming the file and the element.
MotionFolder read_motions(const std::filesystem::path& folder, const std::vector<dataset::ManifestEntry>& wanted,
                          const std::vector<dataset::ManifestEntry>& all);

}  // namespace osteon::app
