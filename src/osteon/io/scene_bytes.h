// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/bytes.h"
#include "osteon/io/scene.h"

namespace osteon::io {

// A Scene as bytes and back, between two processes of the same program on one machine.
Bytes to_bytes(Scene& scene, std::vector<std::string>& repairs);
Scene scene_of_bytes(std::span<const std::uint8_t> bytes, std::vector<std::string>& repairs);  // adds to repairs; throws Error if cut short

}  // namespace osteon::io
