// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/writer.h"

#include <algorithm>
#include <cassert>

namespace osteon::io::gltf {
namespace {

template <class T>
std::span<const std::uint8_t> raw(std::span<const T> values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
}

template <class T>
std::vector<T> narrowed(std::span<const std::uint32_t> values) {
  std::vector<T> out(values.size());
  std::transform(values.begin(), values.end(), out.begin(), [](std::uint32_t v) { return static_cast<T>(v); });
  return out;
}

const char* vector_type(std::size_t components) {
  switch (components) {
    case 2:
      return "VEC2";
    case 3:
      return "VEC3";
    case 4:
      return "VEC4";
    default:
      assert(components == 16);
      return "MAT4";
  }
}

}  // namespace

Writer::Writer(Document& document) : document_(document) {
  assert(document.buffers.size() <= 1);
  if (!document.buffers.empty()) return;
  document.buffers.emplace_back();
  document.json["buffers"] = Json::array({Json{{"byteLength", 0}}});
}

std::size_t Writer::view(std::span<const std::uint8_t> bytes, Target target) {
  Bytes& buffer = document_.buffers[0];
  buffer.resize((buffer.size() + 3) / 4 * 4);
  Json view{{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
  if (target != Target::none) view["target"] = static_cast<int>(target);
  buffer.insert(buffer.end(), bytes.begin(), bytes.end());
  document_.json["buffers"][0]["byteLength"] = buffer.size();
  Json& views = document_.json["bufferViews"];
  views.push_back(std::move(view));
  return views.size() - 1;
}

std::size_t Writer::accessor(std::span<const std::uint8_t> bytes, ComponentType component, const char* type, std::size_t count,
                             Target target) {
  Json accessor{{"bufferView", view(bytes, target)}, {"componentType", static_cast<int>(component)}, {"count", count}, {"type", type}};
  Json& accessors = document_.json["accessors"];
  accessors.push_back(std::move(accessor));
  return accessors.size() - 1;
}

std::size_t Writer::scalars(std::span<const std::uint32_t> values) {
  // 65535 would be the primitive restart value of 16-bit indices.
  const bool small = values.empty() || *std::max_element(values.begin(), values.end()) < 65535;
  if (!small) return accessor(raw(values), ComponentType::u32, "SCALAR", values.size(), Target::indices);
  const auto narrow = narrowed<std::uint16_t>(values);
  return accessor(raw(std::span<const std::uint16_t>(narrow)), ComponentType::u16, "SCALAR", values.size(), Target::indices);
}

std::size_t Writer::vectors(std::span<const float> values, std::size_t components, Target target) {
  return accessor(raw(values), ComponentType::f32, vector_type(components), values.size() / components, target);
}

std::size_t Writer::positions(std::span<const Vec3f> values) {
  assert(!values.empty());
  const std::size_t index = vectors({values.front().data(), 3 * values.size()}, 3, Target::vertices);
  Eigen::AlignedBox3f box;
  for (const Vec3f& p : values) box.extend(p);
  Json& accessor = document_.json["accessors"][index];
  accessor["min"] = {box.min().x(), box.min().y(), box.min().z()};
  accessor["max"] = {box.max().x(), box.max().y(), box.max().z()};
  return index;
}

std::size_t Writer::vec4(std::span<const std::uint32_t> values, std::size_t bytes, bool normalized) {
  const auto add = [&]<class T>(ComponentType type, T) {
    const auto narrow = narrowed<T>(values);
    return accessor(raw(std::span<const T>(narrow)), type, "VEC4", values.size() / 4, Target::vertices);
  };
  const std::size_t index = bytes == 1 ? add(ComponentType::u8, std::uint8_t{}) : add(ComponentType::u16, std::uint16_t{});
  if (normalized) document_.json["accessors"][index]["normalized"] = true;
  return index;
}

std::size_t Writer::image(std::span<const std::uint8_t> bytes) { return view(bytes, Target::none); }

}  // namespace osteon::io::gltf
