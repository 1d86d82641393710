// Groups vectors by direction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "innersphere/vec3.hpp"

namespace innersphere {

/// Groups vectors, and keeps its memory for the next ones.
class DirectionGroups {
 public:
  /// Forgets all vectors and makes room for `most` of them.
  void clear(std::size_t most);

  /// Adds a vector whose length is not zero.
  void add(const Vec3d& vector, double length) {
    const double inverse = 1 / length;
    vectors_[count_] = vector;
    x_[count_] = static_cast<float>(inverse * vector.x);
    y_[count_] = static_cast<float>(inverse * vector.y);
    z_[count_++] = static_cast<float>(inverse * vector.z);
  }

  /// Gives each vector the group whose direction is nearest, of as many groups as it takes for directions
  /// within `max_angle` [rad] of a group's sum. Returns their number, of which some may be empty. Groups
  /// start from where most of the length is: vectors are summed in bins of direction, and groups are made of
  /// bins.
  std::uint32_t group(double max_angle);

  /// Returns the group of vector number k, after group().
  std::uint32_t groupOf(std::size_t k) const { return groups_[k]; }

 private:
  struct Bin {
    Vec3d sum;
    double length2;
  };

  void sumBins(double max_angle);
  void makeDirections(double max_angle);

  std::size_t count_ = 0;
  std::vector<Vec3d> vectors_;
  std::vector<float> x_, y_, z_;  ///< of length one; columns of whole groups of kLanes
  std::vector<std::uint32_t> bin_, groups_;
  std::vector<Vec3d> sums_;  ///< of all bins
  std::vector<Bin> bins_;    ///< those with something in them
  std::vector<Vec3d> group_sums_;
  std::vector<Vec3f> directions_;  ///< of the groups
};

}  // namespace innersphere
