// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace osteon::app {

// An option that takes one of the names and nothing else (CLI::CheckedTransformer also takes the numbers behind an enum's names). What
// `value` holds is the default. Pre: `value` lives as long as the command.
template <class T>
CLI::Option* add_choice(CLI::App& command, const std::string& option, T& value, const std::map<std::string, T>& choices,
                        const std::string& help) {
  std::vector<std::string> names;
  std::string standard;
  for (const auto& [name, choice] : choices) {
    names.push_back(name);
    if (choice == value) standard = name;
  }
  const auto take = [&value, choices](const std::string& name) { value = choices.at(name); };
  return command.add_option_function<std::string>(option, take, help)
      ->check(CLI::IsMember(names).description(""))  // which --help shows anyway
      ->type_name(fmt::format("{}", fmt::join(names, "|")))
      ->default_str(standard);
}

}  // namespace osteon::app
