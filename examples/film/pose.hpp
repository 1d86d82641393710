// Poses as transforms.
#pragma once

#include <Eigen/Geometry>

#include "film.hpp"

namespace innersphere::demo {

/// From an actor's frame to the world.
inline Eigen::Isometry3f transformOf(const Pose& pose) {
  Eigen::Isometry3f transform = Eigen::Isometry3f::Identity();
  transform.linear() =
      Eigen::Quaternionf(pose.rotation[3], pose.rotation[0], pose.rotation[1], pose.rotation[2])
          .toRotationMatrix();
  transform.translation() = Eigen::Vector3f(pose.position[0], pose.position[1], pose.position[2]);
  return transform;
}

}  // namespace innersphere::demo
