// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "osteon/render/camera.h"
#include "osteon/render/image.h"
#include "osteon/rig/rig.h"

namespace osteon::app {

struct ContactSheetOptions {
  int columns = 10;
  int tile = 136;  // width and height of each picture, pixels
};

// All characters in one picture, in rows, each seen at an angle in the colours of its skin weights with its skeleton showing through.
render::Image contact_sheet(const std::vector<Rig>& rigs, const ContactSheetOptions& options = {});

// One such picture, `tile` pixels wide and high, from the given side; `colors` of the surface are linear light.
render::Image tile_picture(const TriangleMesh& mesh, const PerVertex<Vec3f>& colors, const Skeleton& skeleton, const render::View& view,
                           int tile);

}  // namespace osteon::app
