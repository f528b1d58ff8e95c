// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "osteon/io/save.h"
#include "osteon/pipelines/skeleton_fit.h"

namespace osteon::app {

// A skeleton that is there already, in its own file's space, and how it comes to the body.
struct GivenSkeleton {
  io::SkeletonFile file;
  pipelines::SkeletonFit fit;

  Skeleton in_place() const { return transformed(file.skeleton, fit.to_body); }
};

inline GivenSkeleton load_given_skeleton(const std::filesystem::path& path, const TriangleMesh& body) {
  GivenSkeleton given{io::load_skeleton_file(path), {}};
  given.fit = pipelines::fit_skeleton(given.file.skeleton, body);
  return given;
}

}  // namespace osteon::app
