// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "osteon/io/gltf/document.h"

namespace osteon::io::gltf {

enum class ComponentType : int { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };
std::size_t size_of(ComponentType type);

// More elements than this are taken for garbage: sparse and zero-filled accessors need no bytes in the file for the elements they promise.
constexpr std::size_t kMostElements = std::size_t{1} << 25;

// An accessor of a document, checked: all its bytes lie in its buffer. Throws Error otherwise. Keep the document alive.
class Accessor {
 public:
  Accessor(const Document& document, std::size_t accessor);  // pre: accessor < document.count("accessors")

  std::size_t count() const { return count_; }
  std::size_t components() const { return components_; }
  ComponentType type() const { return type_; }
  const std::string& where() const { return where_; }

  // count * components values, element by element, sparse substitutions applied; normalised integers become 0..1 or -1..1.
  std::vector<float> floats() const;
  // The same for unsigned integers. Throws Error if the type is signed or float.
  std::vector<std::uint32_t> integers() const;

 private:
  struct View {
    const std::uint8_t* data = nullptr;  // null: zeros
    std::size_t stride = 0;
  };
  struct Sparse {
    std::vector<std::uint32_t> indices;
    View values;
  };
  static View view_of(const Document& document, const Element& owner, std::size_t count, std::size_t element_size, bool strided);
  void read_sparse(const Document& document, const Element& sparse);
  template <class T, class Convert>
  void read(std::vector<T>& out, Convert convert) const;

  std::string where_;
  ComponentType type_ = ComponentType::f32;
  bool normalized_ = false;
  std::size_t components_ = 1, count_ = 0;
  View view_;
  Sparse sparse_;
};

}  // namespace osteon::io::gltf
