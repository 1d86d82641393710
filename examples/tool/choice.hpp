// Options whose value is one of a few names.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace innersphere::tool {

/// Adds an option that sets `value` by name; help shows the names and the name of the current value as the
/// default.
template <typename T>
CLI::Option* addChoice(CLI::App& command, const std::string& option, T& value,
                       const std::vector<std::pair<std::string, T>>& choices,
                       const std::string& description) {
  std::vector<std::string> names;
  std::string current;
  for (const auto& [name, choice] : choices) {
    names.push_back(name);
    if (choice == value) current = name;
  }
  const auto choose = [&value, choices](const std::string& text) {
    for (const auto& [name, choice] : choices) {
      if (name == text) value = choice;
    }
  };
  return command.add_option_function<std::string>(option, choose, description)
      ->check(CLI::IsMember(names))
      ->default_str(current);
}

}  // namespace innersphere::tool
