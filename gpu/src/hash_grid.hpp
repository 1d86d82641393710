// Builds and owns the hierarchical hash grid of one packing, prefix, set of radii and growth.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/grid_view.hpp"

namespace innersphere {

/// A copy of a grid in the memory of a device; the CUDA backend makes and knows it.
class DeviceGrid {
 public:
  virtual ~DeviceGrid() = default;
  virtual int device() const = 0;
};

/// Immutable once built. Count, scan, fill: every cell holds exactly the spheres that touch it, so no cell
/// can overflow. Spheres have one order throughout, also inside a cell, and the grid depends on nothing but
/// the input.
///
/// With volume-true radii the spheres of one packing overlap a little and a cell holds a few more; nothing
/// relies on how many. Greedy packings of a cube, 4,000 and 60,000 spheres: the fullest cell has 9, and 14
/// with radii grown to the cube's volume. The grid then takes 66 bytes a sphere, its copy of the spheres
/// included.
class HashGrid {
 public:
  /// `growth`: cells list the spheres as if their radii were larger by so much, so that a query with a margin
  /// up to that probes no more cells than one without. The number of spheres is 1 to 2^29, coordinates and
  /// radii up to 1e30.
  HashGrid(std::vector<Sphere> spheres, float growth);

  /// For the CPU; valid as long as the grid.
  const core::GridView& view() const { return view_; }

  std::size_t tableSize() const { return blocks_.size(); }
  std::size_t cellCount() const { return cells_.size() - 1; }
  std::size_t entryCount() const { return entries_.size(); }

  /// Where a sphere of the packing is in the grid's order.
  std::uint32_t placeOf(std::uint32_t id) const { return places_[id]; }

  /// Copies on devices, made on first use there. The lock guards them.
  struct DeviceCopies {
    std::mutex mutex;
    std::vector<std::unique_ptr<DeviceGrid>> copies;
  };
  DeviceCopies& deviceCopies() const { return device_copies_; }

 private:
  void measure(float growth);
  void orderSpheres();
  void boundClusters();
  void fillCells(float growth);
  void fillTable(const std::vector<std::uint64_t>& keys);

  std::vector<Sphere> spheres_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint32_t> places_;
  std::vector<Sphere> clusters_;
  std::vector<core::Block> blocks_;
  std::vector<std::uint32_t> cells_;
  std::vector<std::uint32_t> entries_;
  core::GridView view_{};
  mutable DeviceCopies device_copies_;
};

}  // namespace innersphere
