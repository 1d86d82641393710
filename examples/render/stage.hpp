// One frame of a film, ready for rays.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <optional>

#include "film/film.hpp"

namespace innersphere::demo {

/// What a ray meets.
struct Hit {
  float distance = 0;
  Eigen::Vector3f normal;  ///< unit, towards where the ray came from
  Eigen::Vector3f albedo;  ///< linear, 0 to 1
  bool ground = false;
};

/// Actors of a frame, drawn as surfaces or as spheres, above the film's ground. Safe to use from several
/// threads.
class Stage {
 public:
  /// `view` is surface or spheres.
  Stage(const Film& film, std::size_t frame, View view);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  std::optional<Hit> intersect(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;

  /// True if something is in the way; the ground is not.
  bool occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace innersphere::demo
