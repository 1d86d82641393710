// Names of the library's choices on the command line.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "innersphere/contact_options.hpp"

namespace innersphere::tool {

inline void addBackendOption(Command& command, Backend& backend) {
  command.choice<Backend>("--backend", backend,
                          {{"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"cuda", Backend::cuda}},
                          "Where overlaps are computed; auto chooses by the amount of work");
}

/// Adds the choice of radii and, `with_surface`, of the triangles instead.
inline void addEstimatorOption(Command& command, Estimator& estimator, bool with_surface = false) {
  std::vector<std::pair<std::string, Estimator>> names = {{"raw", Estimator::raw},
                                                          {"volume-true", Estimator::volume_true}};
  std::string help = "Radii of the spheres: as packed (raw), or so that they stand for the whole solid";
  if (with_surface) {
    names.emplace_back("surface", Estimator::surface);
    help += "; or the triangles of both (surface): exact, but slower";
  }
  command.choice<Estimator>("--estimator", estimator, names, help);
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

inline void addResponseOption(Command& command, Response& response) {
  command.choice<Response>(
      "--response", response, responseNames(),
      "How overlap becomes contact: implicit springs, the solver removes it, or the paper's force");
}

}  // namespace innersphere::tool
