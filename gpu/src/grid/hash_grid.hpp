// Builds and owns the hierarchical hash grid of one packing, prefix and set of radii.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/cell_lists.hpp"
#include "grid/cell_spheres.hpp"
#include "grid/cluster_tree.hpp"
#include "grid/grid_plan.hpp"
#include "grid/occupancy.hpp"

namespace innersphere {

/// Holds what building a grid needs besides the grid. Whoever builds many keeps it, and saves its
/// allocations.
struct GridScratch {
  /// Holds a sphere's key in the order of the grid: its level, then its place on the curve.
  struct Place {
    std::uint64_t key;
    std::uint32_t index;
  };
  std::vector<Place> places, spare;
  CellLister lister;
};

/// Owns a grid on the CPU. What each cell lists is counted before it is written, so nothing can overflow, and
/// the grid depends on nothing but the spheres: it is the same for any number of threads.
///
/// With volume-true radii the spheres of one packing overlap a little and a cell lists a few more; nothing
/// relies on how many.
class HashGrid {
 public:
  HashGrid() = default;
  explicit HashGrid(const std::vector<Sphere>& spheres) {
    GridScratch scratch;
    build(spheres.data(), planGrid(spheres.data(), spheres.size()), scratch);
  }

  /// Makes it the grid of these spheres, of which `plan` is, whatever it was before; allocates only where it
  /// needs more memory than ever.
  void build(const Sphere* spheres, const core::GridPlan& plan, GridScratch& scratch);

  /// Returns the grid as a query reads it, valid until the next build.
  const core::GridView& view() const { return view_; }

  /// Returns the lowest size level; spheres of finer levels count as of this one.
  int lowestLevel() const { return lowest_level_; }

  std::size_t tableSize() const { return lists_.table.size(); }

  /// Returns where a sphere of the packing is in the grid's order.
  std::uint32_t placeOf(std::uint32_t id) const { return places_[id]; }

  const ClusterTree& clusterTree() const { return cluster_tree_; }
  const Occupancy& occupancy() const { return occupancy_; }

  /// Returns the spheres of GridView::listed, as columns.
  SphereColumns listedSpheres() const { return listed_spheres_.columns(); }

 private:
  void orderSpheres(const Sphere* spheres, const core::GridPlan& plan, GridScratch& scratch);
  void makeClusters(const core::GridPlan& plan);

  int lowest_level_ = 0;
  std::vector<Sphere> spheres_;
  std::vector<Sphere> centred_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint32_t> places_;
  std::vector<core::Cluster> clusters_;
  ClusterTree cluster_tree_;
  Occupancy occupancy_;
  CellLists lists_;
  ListedSpheres listed_spheres_;
  core::GridView view_{};
};

}  // namespace innersphere
