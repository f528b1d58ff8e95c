// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/importer.h"

// RigNet's rig.txt (github.com/zhan-xu/RigNet), the exchange format of the field: lines in any order
//   joints NAME X Y Z     root NAME     skin VERTEX JOINT WEIGHT [JOINT WEIGHT ...]     hier PARENT CHILD
// beside an OBJ with the same vertex order. It has no joint axes: they are turned along the bones.
namespace osteon::io {

struct RigText {
  Skeleton skeleton;
  std::optional<SkinWeights> weights;  // empty if the file has no skin line
};

// `vertices`: those of the mesh; vertices without a skin line are bound to the root. Repairs are appended. Throws Error naming the line.
RigText load_rigtxt(const std::filesystem::path& path, std::size_t vertices, std::vector<std::string>& repairs);

// Blanks in names become '_', as the format cannot hold them.
void save_rigtxt(const std::filesystem::path& path, const Skeleton& skeleton, const SkinWeights& weights);

namespace rigtxt {
// A rig.txt with the OBJ beside it: hero.obj for hero.txt, hero_rig.txt or hero.rig.txt. Without one: joints alone.
Scene import(const File& file);
}  // namespace rigtxt

}  // namespace osteon::io
