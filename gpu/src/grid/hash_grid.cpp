#include "grid/hash_grid.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "common/radix_sort.hpp"
#include "grid/grid_plan.hpp"

namespace innersphere {

namespace {

/// Calls f(begin, end) for ranges that cover [0, n), in several threads where that pays.
template <typename F>
void forRanges(std::size_t n, const F& f) {
  constexpr std::size_t kGrain = 4096;
  if (n <= kGrain) return f(std::size_t{0}, n);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, kGrain),
                    [&](const auto& range) { f(range.begin(), range.end()); });
}

}  // namespace

void HashGrid::build(const Sphere* spheres, const core::GridPlan& plan, GridScratch& scratch) {
  view_ = plan.view;
  lowest_level_ = plan.lowest_level;
  orderSpheres(spheres, plan, scratch);
  makeClusters(plan);
  scratch.lister.list(plan, centred_.data(), lists_);
  listed_spheres_.build(centred_.data(), lists_.listed);
  view_.cells = lists_.table.data();
  view_.listed = lists_.listed.data();
  view_.listed_count = static_cast<std::uint32_t>(lists_.listed.size()) - CellLists::kPastEnd;
  view_.hash_shift = lists_.hash_shift;
}

void HashGrid::orderSpheres(const Sphere* spheres, const core::GridPlan& plan, GridScratch& scratch) {
  using Place = GridScratch::Place;
  const std::size_t count = view_.count;
  std::vector<Place>& places = scratch.places;
  places.resize(count);
  scratch.spare.resize(count);
  forRanges(count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      places[i] = {plan.keyOf(spheres[i], core::kHilbertTable), static_cast<std::uint32_t>(i)};
  });
  // Spheres of equal keys keep the order of the packing.
  sortByBits(
      places, scratch.spare, [](const Place& place) { return place.key; }, 0, plan.keyBits());
  spheres_.resize(count);
  centred_.resize(count + 1);
  constexpr float kFar = std::numeric_limits<float>::infinity();
  centred_.back() = {kFar, kFar, kFar, -kFar};
  ids_.resize(count);
  places_.resize(count);
  forRanges(count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Sphere& s = spheres[places[k].index];
      spheres_[k] = s;
      centred_[k] = plan.centred(s);
      ids_[k] = places[k].index;
      places_[places[k].index] = static_cast<std::uint32_t>(k);
    }
  });
  view_.spheres = spheres_.data();
  view_.centred = centred_.data();
  view_.ids = ids_.data();
}

void HashGrid::makeClusters(const core::GridPlan& plan) {
  clusters_.clear();
  for (int level = 0; level < plan.levels; ++level) {
    const std::uint32_t end = plan.level_first[level + 1];
    for (std::uint32_t k = plan.level_first[level]; k < end; k += core::kClusterSize)
      clusters_.push_back({{}, k, std::min(core::kClusterSize, end - k)});
  }
  forRanges(clusters_.size(), [&](std::size_t from, std::size_t to) {
    for (std::size_t c = from; c < to; ++c) {
      core::Cluster& cluster = clusters_[c];
      const Sphere* begin = spheres_.data() + cluster.first;
      cluster.ball = ballAround(begin, begin + cluster.count);
    }
  });
  cluster_tree_.build(clusters_);
  view_.clusters = clusters_.data();
  occupancy_.build(view_);
}

}  // namespace innersphere
