// Builds and owns the hierarchical hash grid of one packing, prefix and set of radii.
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

/// The spheres in the order of the grid, relative to its centre, an array for each coordinate, so that a CPU
/// loads several at once. kPadding readable numbers follow the last.
struct Columns {
  static constexpr std::size_t kPadding = 32;
  const float* x;
  const float* y;
  const float* z;
  const float* radius;
};

/// Immutable once built. Spheres are sorted and the runs that share a block or a cluster are found by
/// comparing neighbours, so nothing can overflow, and the grid depends on nothing but the input.
///
/// With volume-true radii the spheres of one packing overlap a little and a cell holds a few more; nothing
/// relies on how many.
class HashGrid {
 public:
  /// The number of spheres is 1 to 2^29, coordinates and radii up to 1e30.
  explicit HashGrid(std::vector<Sphere> spheres);

  /// For the CPU; valid as long as the grid.
  const core::GridView& view() const { return view_; }
  const Columns& columns() const { return columns_; }

  std::size_t tableSize() const { return table_.size(); }

  /// Where a sphere of the packing is in the grid's order.
  std::uint32_t placeOf(std::uint32_t id) const { return places_[id]; }

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
  void splitLevels(const std::vector<Place>& places);
  void makeClusters();
  void makeColumns();
  void fillTable();

  int curve_bits_ = 0;  ///< of a cell's coordinate
  std::vector<Sphere> spheres_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint32_t> places_;
  std::vector<core::Level> levels_;
  std::vector<core::Cluster> clusters_;
  std::vector<core::Block> table_;
  std::vector<float> coordinates_;
  Columns columns_{};
  core::GridView view_{};
  mutable DeviceCopies device_copies_;
};

}  // namespace innersphere
