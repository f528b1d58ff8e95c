// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>
#include <utility>

namespace osteon::app {

// Checks of the numbers that options are given. CLI11's own let NaN pass, and name the largest double where one has to be above 0.
template <class Condition>
CLI::Validator number(std::string expected, Condition holds) {
  return CLI::Validator(
      [expected, holds](std::string& text) {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && holds(value)) return std::string();
        return fmt::format("found {}, expected {}", text, expected);
      },
      "");
}

inline CLI::Validator above_zero() {
  return number("a number above 0", [](double value) { return value > 0.0; });
}
inline CLI::Validator not_negative() {
  return number("0 or more", [](double value) { return value >= 0.0; });
}
inline CLI::Validator within(double least, double most) {
  return number(fmt::format("a number of {} to {}", least, most), [=](double value) { return value >= least && value <= most; });
}

}  // namespace osteon::app
