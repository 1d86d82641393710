// Builds and owns the hierarchical hash grid of one packing, prefix and set of radii.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "cell_lists.hpp"
#include "cluster_tree.hpp"
#include "core/grid_view.hpp"
#include "occupancy.hpp"

namespace innersphere {

/// A copy of a grid in the memory of a device; the CUDA backend makes and knows it.
class DeviceGrid {
 public:
  virtual ~DeviceGrid() = default;
  virtual int device() const = 0;
};

/// What building a grid needs besides the grid. Whoever builds many keeps it, and saves its allocations.
struct GridScratch {
  /// A sphere's key in the order of the grid: its level, then its place on the curve.
  struct Place {
    std::uint64_t key;
    std::uint32_t index;
  };
  std::vector<Place> places, spare;
  std::vector<std::uint32_t> first_places;
  CellLister lister;
};

/// What each cell lists is counted before it is written, so nothing can overflow, and the grid depends on
/// nothing but the spheres: it is the same for any number of threads.
///
/// With volume-true radii the spheres of one packing overlap a little and a cell lists a few more; nothing
/// relies on how many.
class HashGrid {
 public:
  HashGrid() = default;
  explicit HashGrid(const std::vector<Sphere>& spheres) {
    GridScratch scratch;
    build(spheres.data(), spheres.size(), scratch);
  }

  /// Makes it the grid of these spheres, whatever it was before; allocates only where it needs more memory
  /// than ever. Copies on devices are dropped. The number of spheres is 1 to 2^29, coordinates and radii up
  /// to 1e30.
  void build(const Sphere* spheres, std::size_t count, GridScratch& scratch);

  /// For the CPU; valid until the next build.
  const core::GridView& view() const { return view_; }

  /// Spheres of finer levels count as of this one.
  int lowestLevel() const { return lowest_level_; }

  std::size_t tableSize() const { return lists_.table.size(); }

  /// Where a sphere of the packing is in the grid's order.
  std::uint32_t placeOf(std::uint32_t id) const { return places_[id]; }

  const ClusterTree& clusterTree() const { return cluster_tree_; }
  const Occupancy& occupancy() const { return occupancy_; }

  /// Copies on devices, made on first use there. The lock guards them.
  struct DeviceCopies {
    std::mutex mutex;
    std::vector<std::unique_ptr<DeviceGrid>> copies;
  };
  DeviceCopies& deviceCopies() const { return device_copies_; }

 private:
  void measure(const Sphere* spheres, std::size_t count);
  void orderSpheres(const Sphere* spheres, GridScratch& scratch);
  void chooseTiers(GridScratch& scratch);
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
  Occupancy occupancy_;
  CellLists lists_;
  core::GridView view_{};
  mutable DeviceCopies device_copies_;
};

}  // namespace innersphere
