// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/element.h"

#include <cmath>

#include "osteon/base/error.h"

namespace osteon::io::gltf {

void Element::unexpected(std::string_view expected) const {
  std::string found = value_->is_structured() ? value_->type_name() : value_->dump(-1, ' ', true, Json::error_handler_t::replace);
  if (found.size() > 60) found = found.substr(0, 60) + "...";
  throw Error("{}: {}, expected {}", where_, found, expected);
}

std::optional<Element> Element::find(std::string_view key) const {
  if (!value_->is_object()) unexpected("an object");
  const auto found = value_->find(std::string(key));
  if (found == value_->end()) return std::nullopt;
  const char* separator = where_.find(": ") == std::string::npos ? ": " : ".";  // the first step below the file's name
  return Element(*found, where_ + separator + std::string(key));
}

Element Element::at(std::string_view key) const {
  auto found = find(key);
  if (!found) throw Error("{}: no {}", where_, key);
  return *std::move(found);
}

std::size_t Element::size() const {
  if (!value_->is_array()) unexpected("an array");
  return value_->size();
}

std::vector<Element> Element::items() const {
  std::vector<Element> out;
  out.reserve(size());
  for (std::size_t i = 0; i < value_->size(); ++i) out.emplace_back((*value_)[i], fmt::format("{}[{}]", where_, i));
  return out;
}

std::size_t Element::integer() const {
  const double value = value_->is_number() ? value_->get<double>() : -1.0;
  if (!(value >= 0.0 && value <= 9007199254740992.0 && value == std::floor(value))) unexpected("an integer of at least 0");
  return static_cast<std::size_t>(value);
}

std::size_t Element::index(std::size_t limit, std::string_view of_what) const {
  const std::size_t value = integer();
  if (value >= limit) throw Error("{}: {}, but there are {} {}", where_, value, limit, of_what);
  return value;
}

double Element::number() const {
  if (!value_->is_number() || !std::isfinite(value_->get<double>())) unexpected("a finite number");
  return value_->get<double>();
}

bool Element::boolean() const {
  if (!value_->is_boolean()) unexpected("true or false");
  return value_->get<bool>();
}

const std::string& Element::text() const {
  if (!value_->is_string()) unexpected("a string");
  return value_->get_ref<const std::string&>();
}

std::vector<double> Element::numbers(std::size_t n) const {
  if (size() != n) throw Error("{}: {} numbers, expected {}", where_, size(), n);
  std::vector<double> out;
  for (const Element& item : items()) out.push_back(item.number());
  return out;
}

std::size_t Element::integer_or(std::string_view key, std::size_t otherwise) const {
  const auto found = find(key);
  return found ? found->integer() : otherwise;
}

std::string Element::text_or(std::string_view key, std::string otherwise) const {
  const auto found = find(key);
  return found ? found->text() : otherwise;
}

}  // namespace osteon::io::gltf
