// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/left_out.h"

#include <fmt/format.h>

namespace osteon::pipelines {

SkinWeights with_surroundings(const SkinWeights& of_character, const geometry::Surroundings& around) {
  constexpr Influence kRoot{JointId(0), 1.0f};
  SkinWeights out;
  std::uint32_t next = 0;
  for (VertexId v : around.has.ids()) out.append(around.has[v] ? std::span(&kRoot, 1) : of_character[VertexId(next++)]);
  return out;
}

std::string note_of(const geometry::Surroundings& around) {
  return fmt::format("{} of {} vertices are the ground under the character, or far away from it: they were left out and follow the root",
                     around.vertices, around.has.size());
}

}  // namespace osteon::pipelines
