// Where a picture is taken from.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "film/film.hpp"

namespace innersphere::demo {

/// A pinhole camera.
struct Camera {
  Eigen::Vector3f eye;
  Eigen::Vector3f right;    ///< unit; the picture's x axis
  Eigen::Vector3f up;       ///< unit; the picture's y axis, upwards
  Eigen::Vector3f forward;  ///< unit
  float half_width = 0;     ///< of the picture at distance 1
  float half_height = 0;
  float distance = 0;  ///< from the eye to the middle of what is seen [m]

  /// Direction of the ray through (x, y), each from -1 (left, bottom) to 1.
  Eigen::Vector3f direction(float x, float y) const {
    return (forward + x * half_width * right + y * half_height * up).normalized();
  }
};

/// A camera at the film's viewpoint that shows all actors of a frame, as large as the picture allows.
Camera frameCamera(const Film& film, std::size_t frame, double aspect);

/// The same for several frames together.
Camera frameCamera(const Film& film, const std::vector<std::size_t>& frames, double aspect);

}  // namespace innersphere::demo
