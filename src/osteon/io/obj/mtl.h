// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "osteon/io/importer.h"

namespace osteon::io::obj {

// Adds the materials of the MTL file `name` in `folder`: name, diffuse colour, opacity and diffuse texture.
// A file that cannot be read is a repair, not an error: the shape does not depend on it.
void read_mtl(const std::filesystem::path& folder, const std::string& name, std::map<std::string, Scene::Material>& materials,
              std::vector<std::string>& repairs);

}  // namespace osteon::io::obj
