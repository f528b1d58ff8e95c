// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "osteon/io/load.h"
#include "osteon/pipelines/rignet.h"

// Characters with z up come out with y up, as glTF has by its specification, but for those that came as glTF: they keep their frame.
namespace osteon::app {

// Reads a character to be written with a rig. One that stands on the plane z = 0 is turned upright, unless the user or the file says
// which axis is up; asset.repairs tells.
io::Asset load_upright(const std::filesystem::path& input, const io::LoadOptions& options);

// The same where the up axis came out of the rigging; result.report tells. Its `up` becomes the file's axis.
void stand_up(io::Asset& asset, pipelines::RignetResult& result);

}  // namespace osteon::app
