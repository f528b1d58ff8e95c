// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace osteon::io::ply {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };
std::size_t size_of(Type type);

struct Property {
  std::string name;
  Type type;
  std::optional<Type> count_type;  // of a list
};

struct Element {
  std::string name;
  std::size_t count;
  std::vector<Property> properties;

  std::optional<std::size_t> find(std::string_view property) const;
};

struct Header {
  enum class Format { ascii, little_endian, big_endian } format = Format::ascii;
  std::vector<Element> elements;
  std::size_t size = 0;  // bytes up to the first element
};

// Throws Error naming the line for what is no PLY header.
Header parse_header(std::string_view text);

}  // namespace osteon::io::ply
