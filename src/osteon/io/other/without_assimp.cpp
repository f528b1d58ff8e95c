// SPDX-License-Identifier: Apache-2.0
#include "osteon/base/error.h"
#include "osteon/io/other/assimp_import.h"

namespace osteon::io::other {

Scene import(const File&) { throw Error("of no format that is read without Assimp: GLB, glTF, OBJ, PLY, STL and rig.txt"); }

Scene import_here(const File& file) { return import(file); }

}  // namespace osteon::io::other
