// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"
#include "osteon/rig/skeleton.h"

namespace osteon {

struct Influence {
  JointId joint;
  float weight;
  bool operator==(const Influence&) const = default;
};

// The influences of every vertex, one row after the other. Invariants (see validate): every row has at least one influence; weights > 0,
// sorted descending (ties: smaller joint first), no joint twice, sum 1 within 1e-5; joints exist.
class SkinWeights {
 public:
  std::size_t size() const { return offsets_.size() - 1; }  // vertices
  std::span<const Influence> operator[](VertexId v) const {
    return std::span(influences_).subspan(offsets_[index(v)], offsets_[index(v) + 1] - offsets_[index(v)]);
  }
  std::size_t max_influences() const;
  // Appends the next vertex's row: drops non-positive and non-finite weights, adds up weights of one joint, keeps the `limit` largest,
  // sorts and normalises. Returns false, and appends an empty row, when nothing positive is left.
  bool append(std::span<const Influence> row, std::size_t limit = SIZE_MAX);
  bool operator==(const SkinWeights&) const = default;

 private:
  std::vector<std::uint32_t> offsets_{0};
  std::vector<Influence> influences_;
};

// Throws Error naming the first vertex that breaks an invariant.
void validate(const SkinWeights& weights, std::size_t vertices, std::size_t joints);

}  // namespace osteon
