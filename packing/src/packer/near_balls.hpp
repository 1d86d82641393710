// Finds the nearest balls of many points at once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "packer/ball.hpp"

namespace innersphere {

/// Cubes of which half the side is not less than this are divided among threads.
inline constexpr double kSharedHalf = 1.0 / 16;

/// Holds the balls that can be the nearest one to a point of a cube. A cube that is divided hands its balls
/// down, so that few are left where many points are looked at, however far away they are.
class NearBalls {
 public:
  /// All balls, for all of space. The balls have to outlive this object.
  explicit NearBalls(std::span<const Ball> balls);

  /// Those of the parent's balls that can be nearest in a cube inside the parent's.
  NearBalls(const NearBalls& parent, const Point& centre, double half);

  struct Nearest {
    double distance = 0;
    std::uint32_t index = 0;
  };

  /// Returns the ball nearest to a point of the cube; of equally near ones the first. There must be a ball.
  Nearest nearest(const Point& x) const;

  /// Returns how many balls are left.
  std::size_t size() const { return near_.size(); }

  /// Returns true if one ball holds the whole cube.
  bool insideOne() const { return inside_one_; }

 private:
  std::span<const Ball> balls_;
  std::vector<std::uint32_t> near_;  // rising
  bool inside_one_ = false;
};

/// Returns the ball that is nearest to each point. There must be a ball, and the points must lie in the unit
/// cube. Runs in the current TBB arena.
std::vector<NearBalls::Nearest> nearestBalls(std::span<const Point> points, std::span<const Ball> balls);

}  // namespace innersphere
