// Names of the library's choices on the command line.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "choice.hpp"
#include "innersphere/contact_options.hpp"

namespace innersphere::tool {

inline void addBackendOption(CLI::App& command, Backend& backend) {
  addChoice<Backend>(command, "--backend", backend,
                     {{"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"cuda", Backend::cuda}},
                     "Where overlaps are computed; auto chooses by the amount of work");
}

inline void addEstimatorOption(CLI::App& command, Estimator& estimator) {
  addChoice<Estimator>(command, "--estimator", estimator,
                       {{"raw", Estimator::raw}, {"volume-true", Estimator::volume_true}},
                       "Radii of the spheres: as packed (raw), or so that they stand for the whole solid");
}

inline const std::vector<std::pair<std::string, Response>>& responseNames() {
  static const std::vector<std::pair<std::string, Response>> names = {
      {"compliant", Response::compliant}, {"rigid", Response::rigid}, {"penalty", Response::penalty}};
  return names;
}

inline std::string nameOf(Response response) {
  for (const auto& [name, value] : responseNames()) {
    if (value == response) return name;
  }
  return {};
}

inline void addResponseOption(CLI::App& command, Response& response) {
  addChoice<Response>(
      command, "--response", response, responseNames(),
      "How overlap becomes contact: implicit springs, the solver removes it, or the paper's force");
}

}  // namespace innersphere::tool
