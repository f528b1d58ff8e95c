// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/base/random.h"
#include "osteon/dataset/prepared.h"

namespace osteon::dataset {

// The same character without some of its accessories: each goes with probability `share`. An accessory is a small part of the mesh that is
// connected to nothing else and follows one joint as a whole (eyes, a hat, a sword, plates of armour). It may go where the joint keeps most
// of what it moves, or where nothing below the joint moves anything else: then the joint goes too, with the joints below it. So every joint
// that is left stands in a part of the mesh as before, and the labels stay exact. Two thirds of the vertices stay at least. Normalised
// again; poses stay behind. What follows from the shape is left as it was: derive_from_shape(). The same character where nothing goes.
PreparedCharacter without_accessories(const PreparedCharacter& character, float share, Random& random);

}  // namespace osteon::dataset
