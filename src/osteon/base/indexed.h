// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <initializer_list>
#include <ranges>
#include <vector>

namespace osteon {

template <class Id>
concept IdType = std::is_enum_v<Id>;

template <IdType Id>
constexpr std::size_t index(Id id) {
  return static_cast<std::size_t>(id);
}

// All ids 0..n-1, in order: for (VertexId v : ids<VertexId>(n)).
template <IdType Id>
constexpr auto ids(std::size_t n) {
  return std::views::iota(std::size_t{0}, n) | std::views::transform([](std::size_t i) { return static_cast<Id>(i); });
}

// What new items hold: zero for Eigen's fixed vectors too, which their own constructor leaves unset.
template <class T>
T blank() {
  if constexpr (requires { requires(T::SizeAtCompileTime > 0); T::Zero(); })
    return T::Zero();
  else
    return T();
}

// A vector whose operator[] takes the id of what it is indexed by and nothing else.
template <IdType Id, class T>
class Indexed {
 public:
  Indexed() = default;
  explicit Indexed(std::size_t n, const T& value = blank<T>()) : items_(n, value) {}
  explicit Indexed(std::vector<T> items) : items_(std::move(items)) {}
  Indexed(std::initializer_list<T> items) : items_(items) {}

  decltype(auto) operator[](Id id) {
    assert(index(id) < items_.size());
    return items_[index(id)];
  }
  decltype(auto) operator[](Id id) const {
    assert(index(id) < items_.size());
    return items_[index(id)];
  }
  std::size_t size() const { return items_.size(); }
  bool empty() const { return items_.empty(); }
  auto ids() const { return osteon::ids<Id>(items_.size()); }
  void resize(std::size_t n, const T& value = blank<T>()) { items_.resize(n, value); }
  void reserve(std::size_t n) { items_.reserve(n); }
  Id push_back(T item) {
    items_.push_back(std::move(item));
    return static_cast<Id>(items_.size() - 1);
  }
  auto begin() { return items_.begin(); }
  auto end() { return items_.end(); }
  auto begin() const { return items_.begin(); }
  auto end() const { return items_.end(); }
  const T* data() const { return items_.data(); }
  T* data() { return items_.data(); }
  const std::vector<T>& raw() const { return items_; }  // for code that has no use for the id (files, tensors)
  std::vector<T>& raw() { return items_; }
  bool operator==(const Indexed&) const = default;

 private:
  std::vector<T> items_;
};

}  // namespace osteon
