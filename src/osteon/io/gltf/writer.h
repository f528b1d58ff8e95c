// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/base/types.h"
#include "osteon/io/gltf/accessor.h"

namespace osteon::io::gltf {

// What a buffer view is for (specification, bufferView.target).
enum class Target : int { none = 0, vertices = 34962, indices = 34963 };

// Appends arrays to the one buffer of a document, each as an accessor with a buffer view of its own, aligned to 4 bytes.
// Returns the accessor's index. Pre: the document has at most one buffer, without a uri.
class Writer {
 public:
  explicit Writer(Document& document);

  std::size_t scalars(std::span<const std::uint32_t> values);                                 // indices: u16 where they fit, else u32
  std::size_t vectors(std::span<const float> values, std::size_t components, Target target);  // VEC2, VEC3, VEC4 or MAT4
  std::size_t positions(std::span<const Vec3f> values);                                       // VEC3 with min and max
  // VEC4 of unsigned integers in `bytes` (1 or 2) each. Pre: they fit.
  std::size_t vec4(std::span<const std::uint32_t> values, std::size_t bytes, bool normalized);
  std::size_t image(std::span<const std::uint8_t> bytes);  // a buffer view alone; returns its index

 private:
  std::size_t view(std::span<const std::uint8_t> bytes, Target target);
  std::size_t accessor(std::span<const std::uint8_t> bytes, ComponentType component, const char* type, std::size_t count, Target target);

  Document& document_;
};

}  // namespace osteon::io::gltf
