#include "cuda_grid.hpp"

#include <algorithm>
#include <cmath>

namespace innersphere::device {

namespace {

/// Cells that warps look at side by side if they take a whole cluster each.
constexpr double kCellsOfAPart = 512;

/// Cells of the finest tier near a sphere of a level, at most.
double cellsNear(const core::GridPlan& plan, int level) {
  const double radius = std::ldexp(0.5, plan.lowest_level + level - plan.view.finest);  // in cells
  return std::pow(2 * (radius + 0.25) + 2, 3);
}

}  // namespace

bool isDense(const BuildPlan& plan) {
  const Tiers& tiers = plan.tiers;
  for (int t = 0; t < tiers.count; ++t) {
    if (!core::isDense(tiers.of[t], plan.grid.view.count)) return false;
  }
  constexpr std::uint64_t kMostCells = 1u << 27;  // more are not worth their memory, nor fit sums of cells
  return tiers.first[tiers.count] <= kMostCells;
}

BuildPlan makeBuildPlan(const core::GridPlan& grid) {
  BuildPlan plan{};
  plan.grid = grid;
  plan.tiers.count = grid.view.tiers;
  for (int t = 0; t < grid.view.tiers; ++t) {
    plan.tiers.of[t] = core::makeTier(grid, t);
    plan.tiers.first[t + 1] = plan.tiers.first[t] + plan.tiers.of[t].count;
  }
  unsigned cluster = 0;
  for (int level = 0; level < grid.levels; ++level) {
    const unsigned spheres = grid.level_first[level + 1] - grid.level_first[level];
    const unsigned clusters = (spheres + core::kClusterSize - 1) / core::kClusterSize;
    const double cells = std::min(spheres, core::kClusterSize) * cellsNear(grid, level);
    plan.jobs.parts[level] = static_cast<unsigned>(std::clamp(cells / kCellsOfAPart, 1.0, 4096.0));
    plan.jobs.first_cluster[level] = cluster;
    plan.jobs.first[level + 1] = plan.jobs.first[level] + clusters * plan.jobs.parts[level];
    cluster += clusters;
  }
  return plan;
}

void CudaGrid::build(const Sphere* spheres, const core::GridPlan& grid, cudaStream_t stream) {
  const std::uint32_t count = grid.view.count;
  const bool first = !header_.data();
  if (!scratch_) scratch_ = std::make_unique<BuildScratch>();
  scratch_->given.reserve(count);
  copyAsync(scratch_->given.data(), spheres, count, stream);
  header_.reserve(1);
  spheres_.reserve(count);
  ids_.reserve(count);
  places_.reserve(count);
  clusters_.reserve(grid.view.cluster_count);
  groups_.reserve(groupCount(grid.view.cluster_count));
  const BuildPlan plan = makeBuildPlan(grid);
  const bool dense = isDense(plan);
  launchOrder(plan, arrays(), dense, *scratch_, stream);
  if (!dense || !fill(plan, stream)) {
    const BuildStatus status = sortLists(plan, arrays(), *scratch_, stream);
    makeRoom(status, count);
    launchSorted(plan, arrays(), status, *scratch_, stream);
    INNERSPHERE_CUDA(cudaStreamSynchronize(stream));
  }
  if (first) scratch_.reset();
}

/// False if some list is too long for it.
bool CudaGrid::fill(const BuildPlan& plan, cudaStream_t stream) {
  while (true) {
    launchFill(plan, arrays(), *scratch_, stream);
    INNERSPHERE_CUDA(cudaStreamSynchronize(stream));
    const BuildStatus& status = *scratch_->status.data();
    if (status.longest > kLongestInOrder) return false;
    if (fits(status, arrays())) return true;
    makeRoom(status, plan.grid.view.count);
  }
}

/// The first time just enough, then with room to grow.
void CudaGrid::makeRoom(const BuildStatus& status, std::uint32_t spheres) {
  if (status.listed >> 32 != 0)
    throw Error(ErrorCode::bad_argument, "the spheres fill more than 2^32 places in the grid; use fewer");
  if (listed_.capacity() < status.listed) {
    const std::uint64_t room = status.listed + (listed_.capacity() > 0 ? status.listed / 4 : 0);
    listed_.reserve(room);
    entries_.reserve(room + spheres + core::kListStep);
  }
  cells_.reserve(tableSizeFor(status.cells));
}

GridArrays CudaGrid::arrays() const {
  return {spheres_.data(), ids_.data(),        places_.data(),   clusters_.data(),
          groups_.data(),  cells_.data(),      listed_.data(),   entries_.data(),
          header_.data(),  listed_.capacity(), cells_.capacity()};
}

const CudaGrid& gridOnDevice(const ModelGrid& grid, int device, cudaStream_t stream) {
  const core::GridPlan& plan = grid.plan();
  ModelGrid::DeviceGrids& all = grid.onDevices();
  const std::lock_guard<std::mutex> lock(all.mutex);
  CudaGrid* found = nullptr;
  for (const auto& candidate : all.grids) {
    if (candidate->device() == device) found = static_cast<CudaGrid*>(candidate.get());
  }
  if (!found) {
    auto made = std::make_unique<CudaGrid>(device);
    found = made.get();
    all.grids.push_back(std::move(made));
  }
  if (found->version == grid.version()) return *found;
  found->version = 0;
  grid.withSpheres([&](const Sphere* spheres, GridScratch&) { found->build(spheres, plan, stream); });
  found->version = grid.version();
  return *found;
}

}  // namespace innersphere::device
