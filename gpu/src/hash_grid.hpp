// Builds and owns the hierarchical hash grid of one packing, prefix and set of radii.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "cell_lists.hpp"
#include "cluster_tree.hpp"
#include "core/grid_view.hpp"

namespace innersphere {

/// A copy of a grid in the memory of a device; the CUDA backend makes and knows it.
class DeviceGrid {
 public:
  virtual ~DeviceGrid() = default;
  virtual int device() const = 0;
};

/// Immutable once built. What each cell lists is counted before it is written, so nothing can overflow, and
/// the grid depends on nothing but the input.
///
/// With volume-true radii the spheres of one packing overlap a little and a cell lists a few more; nothing
/// relies on how many.
class HashGrid {
 public:
  /// The number of spheres is 1 to 2^29, coordinates and radii up to 1e30.
  explicit HashGrid(std::vector<Sphere> spheres);

  /// For the CPU; valid as long as the grid.
  const core::GridView& view() const { return view_; }

  /// Spheres of finer levels count as of this one.
  int lowestLevel() const { return lowest_level_; }

  std::size_t tableSize() const { return lists_.table.size(); }

  /// Where a sphere of the packing is in the grid's order.
  std::uint32_t placeOf(std::uint32_t id) const { return places_[id]; }

  const ClusterTree& clusterTree() const { return cluster_tree_; }

  /// Copies on devices, made on first use there. The lock guards them.
  struct DeviceCopies {
    std::mutex mutex;
    std::vector<std::unique_ptr<DeviceGrid>> copies;
  };
  DeviceCopies& deviceCopies() const { return device_copies_; }

 private:
  struct Place;
  void measure();
  void orderSpheres();
  void chooseTiers(const std::vector<Place>& places);
  void makeClusters();

  int lowest_level_ = 0;
  int curve_bits_ = 0;  ///< of a cell's coordinate
  std::vector<Sphere> spheres_;
  std::vector<Sphere> centred_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint32_t> places_;
  std::vector<std::uint32_t> level_first_;  ///< place of the first sphere of each level, from the lowest on
  std::vector<core::Cluster> clusters_;
  ClusterTree cluster_tree_;
  CellLists lists_;
  core::GridView view_{};
  mutable DeviceCopies device_copies_;
};

}  // namespace innersphere
