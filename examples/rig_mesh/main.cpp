// SPDX-License-Identifier: Apache-2.0
// rig_mesh IN OUT.glb: what `osteon rig` does, in ten lines.
#include <cstdio>

#include "osteon/base/error.h"
#include "osteon/io/load.h"
#include "osteon/io/save.h"
#include "osteon/pipelines/rignet.h"

int main(int argc, char** argv) try {
  if (argc != 3) throw osteon::Error("usage: rig_mesh IN OUT.glb");
  const auto asset = osteon::io::load(argv[1]);
  const auto models = osteon::infer::RignetModels::load();
  const auto rig = osteon::pipelines::rig_character(asset.mesh, models);
  osteon::io::save_glb(argv[2], asset, rig.skeleton, rig.weights);
} catch (const std::exception& e) {
  std::fprintf(stderr, "error: %s\n", e.what());
  return 2;
}
