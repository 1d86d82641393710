// Keeps the octree's leaves by the largest sphere they could hold.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "packer/ball.hpp"

namespace innersphere {

/// This is a cube of the octree over the unit cube in which a sphere may still be centred.
struct Cell {
  std::array<std::uint32_t, 3> at{};  ///< integer position: the cube spans at * side to (at + 1) * side
  float upper = 1;                    ///< no larger sphere is centred in it
  std::uint8_t level = 0;             ///< side 2^-level

  static constexpr int kDeepest = 30;

  double side() const { return 1.0 / (std::uint32_t{1} << level); }
  Point centre() const { return Point(at[0] + 0.5, at[1] + 0.5, at[2] + 0.5) * side(); }

  /// Returns one of the eight cells of half the side, 0 to 7, with the bound that it inherits.
  Cell child(int octant) const;
};

/// Returns the position along the Z-order curve of the cell's ancestor at `level`, or of its first descendant
/// there.
std::uint64_t mortonCode(const Cell& cell, int level);

/// Holds the rounds' fixed radii: a falling geometric sequence, in single precision so that bounds compare
/// exactly.
class RadiusSchedule {
 public:
  RadiusSchedule(double first, double last, double ratio);
  float operator[](std::size_t step) const { return radii_[std::min(step, radii_.size() - 1)]; }
  std::size_t size() const { return radii_.size(); }

  /// Returns the step with (*this)[step + 1] < radius <= (*this)[step].
  std::size_t below(float radius) const;

 private:
  std::vector<float> radii_;
};

/// Holds all live cells, in one bucket for each step of the radius schedule, so that the largest are found
/// without sorting.
class CellQueue {
 public:
  explicit CellQueue(const RadiusSchedule& schedule) : schedule_(schedule), buckets_(schedule.size()) {}

  /// Adds a cell. Cells that can only hold spheres smaller than the last step are forgotten.
  void push(const Cell& cell);

  bool empty() const { return live_ == 0; }
  std::size_t live() const { return live_; }

  /// Returns the first step that has cells, or the radius schedule's size if none has.
  std::size_t top() const;

  /// Returns how many cells may hold a sphere larger than step `until`.
  std::size_t countAbove(std::size_t until) const;

  /// Removes the cells that may hold a sphere larger than step `until` and returns them.
  std::vector<Cell> takeAbove(std::size_t until);

 private:
  const RadiusSchedule& schedule_;
  std::vector<std::vector<Cell>> buckets_;
  std::size_t live_ = 0;
};

}  // namespace innersphere
