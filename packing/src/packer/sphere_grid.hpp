// Finds placed spheres by place.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "packer/ball.hpp"

namespace innersphere {

/// This is a hierarchical hash grid of balls inside the unit cube: a ball is listed once, in the cell of its
/// centre on the level whose cells are just as wide as the ball or up to twice as wide. Reading from several
/// threads is safe.
class SphereGrid {
 public:
  SphereGrid();
  explicit SphereGrid(std::span<const Ball> balls);

  void insert(const Ball& ball);
  const std::vector<Ball>& balls() const { return balls_; }

  /// Calls visit(index) for every ball that comes nearer than `reach` to the box, and for some others.
  template <class Visit>
  void visitNear(const Point& lower, const Point& upper, double reach, Visit&& visit) const;

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t index = 0;
  };

  /// Returns the ball with the smallest distance below `cutoff`; the distance is infinity if there is none.
  Nearest nearest(const Point& x, double cutoff) const;

 private:
  static constexpr int kLevels = 20;  // cells of 1 to 2^-19; smaller balls share the last level
  static constexpr std::uint32_t kNone = ~0u;

  struct Slot {
    std::uint64_t key = ~0ull;
    std::uint32_t head = kNone;
  };

  static int levelOf(double radius);
  static std::int64_t coordinate(double x, int level);
  static std::uint64_t keyOf(int level, std::int64_t x, std::int64_t y, std::int64_t z);
  Slot& slot(std::uint64_t key);
  std::uint32_t head(std::uint64_t key) const;
  void grow();

  std::vector<Ball> balls_;
  std::vector<std::uint32_t> next_;  // ball -> next ball in the same cell
  std::vector<Slot> slots_;          // open addressing, a power of two
  std::size_t used_ = 0;
  std::array<std::vector<std::uint32_t>, kLevels> by_level_;
};

template <class Visit>
void SphereGrid::visitNear(const Point& lower, const Point& upper, double reach, Visit&& visit) const {
  for (int level = 0; level < kLevels; ++level) {
    const std::vector<std::uint32_t>& members = by_level_[level];
    if (members.empty()) continue;
    const double margin = reach + 0.5 / (1 << level);  // a ball's radius is at most half a cell
    std::int64_t from[3], to[3];
    double cells = 1;
    for (int k = 0; k < 3; ++k) {
      from[k] = coordinate(lower[k] - margin, level);
      to[k] = coordinate(upper[k] + margin, level);
      cells *= static_cast<double>(to[k] - from[k] + 1);
    }
    if (cells > static_cast<double>(members.size())) {
      for (std::uint32_t i : members) visit(i);
      continue;
    }
    for (std::int64_t z = from[2]; z <= to[2]; ++z) {
      for (std::int64_t y = from[1]; y <= to[1]; ++y) {
        for (std::int64_t x = from[0]; x <= to[0]; ++x) {
          for (std::uint32_t i = head(keyOf(level, x, y, z)); i != kNone; i = next_[i]) visit(i);
        }
      }
    }
  }
}

}  // namespace innersphere
