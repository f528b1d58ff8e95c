// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace osteon::io::gltf {

using Json = nlohmann::ordered_json;  // keeps the order of keys, so that what is not ours goes out as it came in

// A value of a JSON document with the place where it stands ("hero.glb: nodes[3].mesh"): every access is checked, and an Error names the
// place.
class Element {
 public:
  Element(const Json& value, std::string where) : value_(&value), where_(std::move(where)) {}

  const Json& json() const { return *value_; }
  const std::string& where() const { return where_; }

  std::optional<Element> find(std::string_view key) const;  // of an object; empty if absent
  Element at(std::string_view key) const;                   // of an object; must be there
  std::vector<Element> items() const;                       // of an array
  std::size_t size() const;                                 // of an array

  std::size_t integer() const;  // not negative, at most 2^53
  std::size_t index(std::size_t limit, std::string_view of_what) const;
  double number() const;  // finite
  bool boolean() const;
  const std::string& text() const;
  template <std::size_t N>
  std::array<double, N> numbers() const {  // of an array of N
    const auto all = numbers(N);
    std::array<double, N> out;
    std::copy(all.begin(), all.end(), out.begin());
    return out;
  }
  std::size_t integer_or(std::string_view key, std::size_t otherwise) const;
  std::string text_or(std::string_view key, std::string otherwise) const;

 private:
  std::vector<double> numbers(std::size_t n) const;
  [[noreturn]] void unexpected(std::string_view expected) const;

  const Json* value_;
  std::string where_;
};

}  // namespace osteon::io::gltf
