// Finds how much a ball adds to a union of balls that is to fill a solid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "packer/container.hpp"

namespace innersphere {

/// Cuts space into cells, each of which knows how much of it is in the solid and how many balls hold its
/// centre. What a ball would add is summed by rows of cells, whose sums up to each cell are kept: that takes
/// a root and two look-ups for each row that meets the ball.
class UnionLattice {
 public:
  /// Takes cells of this size, larger ones where there would be too many. Volume outside of the solid counts
  /// `outside_weight` times against volume inside. Runs in the current TBB arena.
  UnionLattice(const Container& container, double spacing, double outside_weight);

  double spacing() const { return spacing_; }

  /// Returns the volume inside the solid that the ball adds to the union, less the weighted one outside, in
  /// cells.
  double gain(const Ball& ball) const;

  void add(const Ball& ball) { change(ball, 1); }
  void remove(const Ball& ball) { change(ball, -1); }

  /// Returns about `wanted` balls of the largest radius inside the solid, with centres all over it. Runs in
  /// the current TBB arena.
  std::vector<Ball> innerBalls(double wanted) const;

 private:
  using Index = std::ptrdiff_t;

  template <typename Visit>
  void visitRows(const Ball& ball, const Visit& visit) const;
  void change(const Ball& ball, int by);
  void sumRow(Index row);
  Point centreOf(Index row, Index x) const;
  bool isInside(std::size_t cell) const;

  const Container& container_;
  double spacing_ = 1;
  Index size_[3] = {};  // cells along each axis
  Point origin_;
  std::int32_t outside_ = 0;            // weight of a cell outside
  std::vector<std::int32_t> weights_;   // of cells
  std::vector<std::uint16_t> holding_;  // balls that hold each cell
  std::vector<std::int32_t> sums_;      // of the weights of cells that no ball holds, before each along a row
};

}  // namespace innersphere
