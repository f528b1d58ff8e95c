// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/motion.h"

#include "osteon/base/error.h"
#include "osteon/io/bvh/bvh.h"
#include "osteon/io/gltf/animation.h"

namespace osteon::io {

Motion read_motion(const std::filesystem::path& path, Bytes bytes, double per_second) {
  Motion motion;
  if (gltf::is_gltf(bytes)) {
    std::vector<std::string> repairs;  // of the buffers, where poses are not concerned
    motion = gltf::poses_of(gltf::parse(path, std::move(bytes), repairs), per_second);
  } else {
    motion = bvh::poses_of(path.filename().string(), text_of(bytes), per_second);
  }
  if (motion.poses.empty()) throw Error("{}: found no pose, expected an animation", path.filename().string());
  return motion;
}

}  // namespace osteon::io
