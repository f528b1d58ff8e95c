// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/ply/header.h"

#include <array>

#include "osteon/base/error.h"
#include "osteon/io/text_scanner.h"

namespace osteon::io::ply {
namespace {

Type type_of(std::string_view word, std::size_t line) {
  constexpr std::array<std::pair<std::string_view, Type>, 16> kTypes{{{"char", Type::i8},
                                                                      {"int8", Type::i8},
                                                                      {"uchar", Type::u8},
                                                                      {"uint8", Type::u8},
                                                                      {"short", Type::i16},
                                                                      {"int16", Type::i16},
                                                                      {"ushort", Type::u16},
                                                                      {"uint16", Type::u16},
                                                                      {"int", Type::i32},
                                                                      {"int32", Type::i32},
                                                                      {"uint", Type::u32},
                                                                      {"uint32", Type::u32},
                                                                      {"float", Type::f32},
                                                                      {"float32", Type::f32},
                                                                      {"double", Type::f64},
                                                                      {"float64", Type::f64}}};
  for (const auto& [name, type] : kTypes)
    if (word == name) return type;
  throw Error("line {}: property type '{}' is unknown", line, word);
}

Header::Format format_of(std::string_view word, std::size_t line) {
  if (word == "ascii") return Header::Format::ascii;
  if (word == "binary_little_endian") return Header::Format::little_endian;
  if (word == "binary_big_endian") return Header::Format::big_endian;
  throw Error("line {}: format '{}', expected ascii, binary_little_endian or binary_big_endian", line, word);
}

Property property_of(TextScanner& scan) {
  Property property;
  std::string_view word = scan.word();
  if (word == "list") {
    property.count_type = type_of(scan.word(), scan.line());
    if (*property.count_type == Type::f32 || *property.count_type == Type::f64)
      throw Error("line {}: a list's length must be an integer", scan.line());
    word = scan.word();
  }
  property.type = type_of(word, scan.line());
  property.name = scan.word();
  return property;
}

}  // namespace

std::size_t size_of(Type type) {
  switch (type) {
    case Type::i8:
    case Type::u8:
      return 1;
    case Type::i16:
    case Type::u16:
      return 2;
    case Type::i32:
    case Type::u32:
    case Type::f32:
      return 4;
    case Type::f64:
      return 8;
  }
  return 0;
}

std::optional<std::size_t> Element::find(std::string_view property) const {
  for (std::size_t p = 0; p < properties.size(); ++p)
    if (properties[p].name == property) return p;
  return std::nullopt;
}

Header parse_header(std::string_view text) {
  Header header;
  TextScanner scan(text);
  if (scan.word() != "ply") throw Error("line 1: expected 'ply'");
  bool has_format = false;
  for (scan.next_line(); !scan.at_end(); scan.next_line()) {
    const std::string_view keyword = scan.word();
    if (keyword == "format") {
      header.format = format_of(scan.word(), scan.line());
      has_format = true;
    } else if (keyword == "element") {
      const std::string name(scan.word());
      const auto count = TextScanner::to_integer(scan.word());
      if (!count || *count < 0) throw Error("line {}: element '{}' has no count", scan.line(), name);
      header.elements.push_back({name, static_cast<std::size_t>(*count), {}});
    } else if (keyword == "property") {
      if (header.elements.empty()) throw Error("line {}: a property before any element", scan.line());
      header.elements.back().properties.push_back(property_of(scan));
    } else if (keyword == "end_header") {
      if (!has_format) throw Error("no format line before end_header");
      scan.next_line();
      header.size = text.size() - scan.bytes_left();
      return header;
    }
  }
  throw Error("no end_header");
}

}  // namespace osteon::io::ply
