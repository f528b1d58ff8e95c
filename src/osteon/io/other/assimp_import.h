// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/importer.h"

namespace osteon::io::other {

// Everything that Assimp reads: FBX and DAE with skins, 3DS and others. Units and up axis as the file says. Assimp runs in a process of its
// own, as it may crash on malformed files.
Scene import(const File& file);

// The same in this process, for the fuzzer.
Scene import_here(const File& file);

}  // namespace osteon::io::other
