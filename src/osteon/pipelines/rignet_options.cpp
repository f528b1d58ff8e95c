// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/rignet_options.h"

#include "osteon/base/error.h"

namespace osteon::pipelines {

void validate(const RignetOptions& options) {
  if (options.bandwidth && !(*options.bandwidth >= kFinestBandwidth && *options.bandwidth <= kCoarsestBandwidth))
    throw Error("bandwidth: {} found, expected {} to {}", *options.bandwidth, kFinestBandwidth, kCoarsestBandwidth);
  if (!(options.detail >= 0.0f && options.detail <= 1.0f)) throw Error("detail: {} found, expected 0 to 1", options.detail);
  if (options.joints && *options.joints < 1) throw Error("joints: 0 found, expected at least 1");
  if (options.skin.max_influences < 1) throw Error("max influences: 0 found, expected at least 1");
  if (options.ablation.bones < 1 || options.ablation.bones > geometry::kBindBones)
    throw Error("bones of a vertex: {} found, expected 1 to {}", options.ablation.bones, geometry::kBindBones);
  if (options.skeleton) osteon::validate(*options.skeleton);
}

}  // namespace osteon::pipelines
