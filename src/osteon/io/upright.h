// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/load.h"

namespace osteon::io {

// Turns a character that was read with y up but has z up, so that the document that save_glb makes of it has y up, as glTF has by its
// specification: mesh, normals and the skeleton that it has; asset.up becomes z. An asset that came from glTF keeps its own frame: then
// nothing is changed, and the result is false.
// A skeleton found for it meanwhile is turned by turn_to_y_up(UpAxis::z), too. Pre: asset.up is y.
bool turn_upright(Asset& asset);

// The turn that takes an axis to y; exact (0, 1 and -1 only).
Eigen::Matrix3f turn_to_y_up(UpAxis up);

}  // namespace osteon::io
