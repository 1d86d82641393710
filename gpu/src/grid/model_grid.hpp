// Declares the grid of one prefix of a model and one set of radii, on whatever processors it is used.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "grid/hash_grid.hpp"
#include "innersphere/packing.hpp"

namespace innersphere {

/// This is a grid in the memory of a device; the CUDA backend makes and knows it.
class DeviceGrid {
 public:
  virtual ~DeviceGrid() = default;
  virtual int device() const = 0;
};

/// Gives the spheres of a grid.
class GridSource {
 public:
  virtual ~GridSource() = default;
  /// Returns a number that counts the changes of the spheres, from 1 on.
  virtual std::uint64_t version() const = 0;
  /// Calls use(spheres, scratch) with them, in the order of the packing.
  using Use = std::function<void(const Sphere*, GridScratch&)>;
  virtual void withSpheres(std::size_t count, const VolumeTrueRadii* radii, const Use& use) = 0;
  /// Returns the volume of the solid that spheres of these radii stand for; 0 if it is not known.
  virtual double volume(const VolumeTrueRadii* radii) const = 0;
};

/// Holds the grid of one prefix and set of radii. What is known of a grid comes first; the grid itself is
/// built by each processor when a query first needs it there, and anew, in its old memory, after the spheres
/// have changed. Safe to use from several threads, but not while the spheres change.
class ModelGrid {
 public:
  /// Makes a grid of the first `count` spheres; `radii` is null for those of the spheres. Builds nothing yet.
  ModelGrid(GridSource& source, std::size_t count, const VolumeTrueRadii* radii)
      : source_(source), count_(count), radii_(radii) {}

  const core::GridPlan& plan() const {
    bring(planned_, [&](const Sphere* spheres, GridScratch&) {
      plan_ = planGrid(spheres, count_);
      plan_.view.volume = source_.volume(radii_);
    });
    return plan_;
  }

  const HashGrid& onCpu() const {
    plan();
    bring(built_, [&](const Sphere* spheres, GridScratch& scratch) { grid_.build(spheres, plan_, scratch); });
    return grid_;
  }

  std::uint64_t version() const { return source_.version(); }

  void withSpheres(const GridSource::Use& use) const { source_.withSpheres(count_, radii_, use); }

  /// Holds the grids on devices; the lock guards them.
  struct DeviceGrids {
    std::mutex mutex;
    std::vector<std::unique_ptr<DeviceGrid>> grids;
  };
  DeviceGrids& onDevices() const { return on_devices_; }

 private:
  template <typename Make>
  void bring(std::atomic<std::uint64_t>& version, const Make& make) const {
    const std::uint64_t now = source_.version();
    if (version.load(std::memory_order_acquire) == now) return;
    const std::lock_guard lock(mutex_);
    if (version.load(std::memory_order_relaxed) == now) return;
    withSpheres(make);
    version.store(now, std::memory_order_release);
  }

  GridSource& source_;
  std::size_t count_;
  const VolumeTrueRadii* radii_;
  mutable std::mutex mutex_;
  mutable std::atomic<std::uint64_t> planned_{0}, built_{0};  ///< versions of the spheres
  mutable core::GridPlan plan_{};
  mutable HashGrid grid_;
  mutable DeviceGrids on_devices_;
};

}  // namespace innersphere
