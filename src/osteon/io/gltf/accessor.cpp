// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/accessor.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "osteon/base/error.h"

namespace osteon::io::gltf {
namespace {

ComponentType component_type(const Element& element) {
  const std::size_t type = element.integer();
  for (const int known : {5120, 5121, 5122, 5123, 5125, 5126})
    if (type == static_cast<std::size_t>(known)) return static_cast<ComponentType>(known);
  throw Error("{}: {}, expected 5120, 5121, 5122, 5123, 5125 or 5126", element.where(), type);
}

std::size_t component_count(const Element& element) {
  constexpr std::array<std::pair<std::string_view, std::size_t>, 7> kTypes{
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
  for (const auto& [name, components] : kTypes)
    if (element.text() == name) return components;
  throw Error("{}: '{}', expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4", element.where(), element.text());
}

// Calls body with a value of the C++ type that `type` stands for.
template <class Body>
void with_type(ComponentType type, Body body) {
  switch (type) {
    case ComponentType::i8:
      return body(std::int8_t{});
    case ComponentType::u8:
      return body(std::uint8_t{});
    case ComponentType::i16:
      return body(std::int16_t{});
    case ComponentType::u16:
      return body(std::uint16_t{});
    case ComponentType::u32:
      return body(std::uint32_t{});
    case ComponentType::f32:
      return body(float{});
  }
}

template <class Stored>
Stored load(const std::uint8_t* bytes) {
  Stored value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace

std::size_t size_of(ComponentType type) {
  std::size_t size = 0;
  with_type(type, [&](auto value) { size = sizeof value; });
  return size;
}

Accessor::Accessor(const Document& document, std::size_t accessor) {
  const Element element = document.at("accessors", accessor);
  where_ = element.where();
  type_ = component_type(element.at("componentType"));
  components_ = component_count(element.at("type"));
  count_ = element.at("count").integer();
  if (count_ > kMostElements) throw Error("{}.count: {}, expected at most {}", where_, count_, kMostElements);
  if (const auto normalized = element.find("normalized")) normalized_ = normalized->boolean();
  if (element.find("bufferView")) view_ = view_of(document, element, count_, components_ * size_of(type_), true);
  if (const auto sparse = element.find("sparse")) read_sparse(document, *sparse);
}

Accessor::View Accessor::view_of(const Document& document, const Element& owner, std::size_t count, std::size_t element_size,
                                 bool strided) {
  const Element view = document.at("bufferViews", owner.at("bufferView").index(document.count("bufferViews"), "bufferViews"));
  const Bytes& buffer = document.buffers[view.at("buffer").index(document.buffers.size(), "buffers")];
  const std::size_t begin = view.integer_or("byteOffset", 0), length = view.at("byteLength").integer();
  if (begin > buffer.size() || length > buffer.size() - begin)
    throw Error("{}: bytes {} to {}, but the buffer has {}", view.where(), begin, begin + length, buffer.size());
  std::size_t stride = strided ? view.integer_or("byteStride", element_size) : element_size;
  if (stride < element_size || stride > 65536) throw Error("{}.byteStride: {}, expected at least {}", view.where(), stride, element_size);
  const std::size_t offset = owner.integer_or("byteOffset", 0);
  const std::size_t needed = count == 0 ? 0 : (count - 1) * stride + element_size;
  if (offset > length || needed > length - offset)
    throw Error("{}: {} elements of {} bytes at byte {}, but {} has {} bytes", owner.where(), count, element_size, offset, view.where(),
                length);
  return {buffer.data() + begin + offset, stride};
}

void Accessor::read_sparse(const Document& document, const Element& sparse) {
  const std::size_t count = sparse.at("count").integer();
  if (count > count_) throw Error("{}.count: {}, but the accessor has {} elements", sparse.where(), count, count_);
  const Element indices = sparse.at("indices");
  const ComponentType type = component_type(indices.at("componentType"));
  const View view = view_of(document, indices, count, size_of(type), false);
  with_type(type, [&]<class Stored>(Stored) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto index = static_cast<double>(load<Stored>(view.data + i * view.stride));
      if (!(index >= 0.0 && index < static_cast<double>(count_)))
        throw Error("{}: {}, but the accessor has {} elements", indices.where(), index, count_);
      sparse_.indices.push_back(static_cast<std::uint32_t>(index));
    }
  });
  sparse_.values = view_of(document, sparse.at("values"), count, components_ * size_of(type_), false);
}

template <class T, class Convert>
void Accessor::read(std::vector<T>& out, Convert convert) const {
  out.assign(count_ * components_, T{});
  with_type(type_, [&]<class Stored>(Stored) {
    const auto copy = [&](const std::uint8_t* from, std::size_t to) {
      for (std::size_t c = 0; c < components_; ++c) out[to * components_ + c] = convert(load<Stored>(from + c * sizeof(Stored)));
    };
    if (view_.data)
      for (std::size_t i = 0; i < count_; ++i) copy(view_.data + i * view_.stride, i);
    for (std::size_t i = 0; i < sparse_.indices.size(); ++i) copy(sparse_.values.data + i * sparse_.values.stride, sparse_.indices[i]);
  });
}

std::vector<float> Accessor::floats() const {
  std::vector<float> out;
  read(out, [this]<class Stored>(Stored value) {
    if constexpr (std::is_integral_v<Stored>)
      if (normalized_) return std::max(static_cast<float>(value) / static_cast<float>(std::numeric_limits<Stored>::max()), -1.0f);
    return static_cast<float>(value);
  });
  return out;
}

std::vector<std::uint32_t> Accessor::integers() const {
  if (type_ != ComponentType::u8 && type_ != ComponentType::u16 && type_ != ComponentType::u32)
    throw Error("{}.componentType: {}, expected an unsigned integer", where_, static_cast<int>(type_));
  std::vector<std::uint32_t> out;
  read(out, []<class Stored>(Stored value) {
    if constexpr (std::is_same_v<Stored, float>)
      return std::uint32_t{0};  // excluded above
    else
      return static_cast<std::uint32_t>(value);
  });
  return out;
}

}  // namespace osteon::io::gltf
