// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/upright.h"

#include <cassert>

#include "osteon/io/source_document.h"

namespace osteon::io {

Eigen::Matrix3f turn_to_y_up(UpAxis up) {
  Eigen::Matrix3f turn = Eigen::Matrix3f::Identity();
  if (up == UpAxis::x) turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  if (up == UpAxis::z) turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return turn;
}

bool turn_upright(Asset& asset) {
  assert(asset.up == UpAxis::y);
  if (asset.source && asset.source->gltf) return false;
  const Eigen::Matrix3f turn = turn_to_y_up(UpAxis::z);
  for (Vec3f& p : asset.mesh.positions) p = turn * p;
  if (asset.skeleton) asset.skeleton = turned(std::move(*asset.skeleton), turn);
  if (asset.source) {
    SourceDocument source = *asset.source;
    for (Vec3f& n : source.appearance->normals.values) n = turn * n;
    for (Appearance::Morph& morph : source.appearance->morphs)
      for (Vec3f& offset : morph.offsets) offset = turn * offset;
    asset.source = std::make_shared<const SourceDocument>(std::move(source));
  }
  asset.up = UpAxis::z;
  return true;
}

}  // namespace osteon::io
