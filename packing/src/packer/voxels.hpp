// Makes a set of sample points of a solid, to find how much of it two placements share.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "packer/container.hpp"

namespace innersphere {

/// Says where a copy of the solid is, in the packer's coordinates: x -> rotation x + shift.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Point shift = Point::Zero();

  Point apply(const Point& x) const { return rotation * x + shift; }
};

/// This is a lattice with a jittered point in each cell, and whether that is inside the solid. Both solids of
/// an overlap are sampled so: the points of the copy are looked up in the cells of the original. The mean
/// over many jitters would be exact, whatever the shape.
class Voxels {
 public:
  /// Takes about `wanted` points inside; fewer if the solid is thin. Runs in the current TBB arena.
  Voxels(const Container& container, double volume, double wanted);

  /// Returns the points inside, in two halves.
  const std::array<std::vector<Eigen::Vector3f>, 2>& points() const { return points_; }

  struct Shared {
    double fraction = 0;  ///< of the solid's volume
    double error = 0;     ///< standard error of it: half of the difference of two halves of the points
  };

  /// Returns what the solid shares with its copy.
  Shared shared(const Pose& pose) const;

  /// Returns one of the points inside; `part` is in [0, 1). There must be one.
  Point point(double part) const;

 private:
  using Index = std::array<std::uint32_t, 3>;

  /// This is a cube of cells. The points of a copy's block that lands far from the surface need not be looked
  /// at one by one.
  struct Block {
    Point centre;
    double distance = 0;  ///< of its middle from the surface; negative outside
  };

  /// The points of a block that lie inside; there are no others in it.
  struct Run {
    Point centre;
    std::array<std::size_t, 2> begin{}, end{};
  };

  std::size_t bit(const Index& at) const {
    return (std::size_t{at[2]} * size_[1] + at[1]) * size_[0] + at[0];
  }
  bool isInside(std::size_t bit) const { return inside_[bit / 8] >> bit % 8 & 1; }
  void setInside(std::size_t bit) { inside_[bit / 8] |= static_cast<std::uint8_t>(1 << bit % 8); }
  const Block* blockAt(const Point& x) const;

  Point origin_;
  double spacing_ = 1;
  Index size_{}, blocks_in_{};
  double reach_ = 0;  // from the middle of a block to its corners
  std::vector<Block> blocks_;
  // A bit for each cell. Eight cells along x make a byte and belong to one block, so that threads share none.
  std::vector<std::uint8_t> inside_;
  std::array<std::vector<Eigen::Vector3f>, 2> points_;  // inside, in two halves, in the order of blocks
  std::vector<Run> runs_;
};

}  // namespace innersphere
