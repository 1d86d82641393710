// Checks of numbers on the command line, with messages that show what was given and what would be right.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace innersphere::tool {

inline CLI::Validator numberThat(bool (*is_good)(double), const std::string& wanted) {
  return CLI::Validator(
      [is_good, wanted](std::string& text) {
        double number = 0;
        if (CLI::detail::lexical_cast(text, number) && std::isfinite(number) && is_good(number))
          return std::string();
        return text + " is not " + wanted;
      },
      "");
}

inline CLI::Validator positive() {
  return numberThat([](double x) { return x > 0; }, "a number above 0");
}

inline CLI::Validator notNegative() {
  return numberThat([](double x) { return x >= 0; }, "a number of at least 0");
}

}  // namespace innersphere::tool
