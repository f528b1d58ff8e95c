// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace osteon {

// Bad input from outside: a file, an option, a mesh. The text names the file, the element, what was found and what was expected.
// (Our own mistakes are assert()s; "no answer exists" is an empty std::optional.)
class Error : public std::runtime_error {
 public:
  template <class... Args>
  explicit Error(fmt::format_string<Args...> text, Args&&... args)
      : std::runtime_error(fmt::format(text, std::forward<Args>(args)...)) {}
};

}  // namespace osteon
