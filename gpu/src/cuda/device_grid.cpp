#include "cuda/device_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace innersphere::device {

namespace {

/// Cells near a sphere, at most, if its level is `above` that of the grid level's largest query spheres,
/// whose diameter is half a cell.
double cellsNear(int above) {
  const double radius = std::ldexp(0.25, above);  // in cells
  return std::pow(2 * (radius + 0.25) + 2, 3);
}

}  // namespace

bool isDense(const BuildPlan& plan) {
  const GridLevels& grid_levels = plan.grid_levels;
  for (int t = 0; t < grid_levels.count; ++t) {
    if (!core::isDense(grid_levels.of[t], plan.grid.view.count)) return false;
  }
  constexpr std::uint64_t kMostCells = 1u << 27;  // more are not worth their memory, nor fit sums of cells
  return grid_levels.first[grid_levels.count] <= kMostCells;
}

BuildPlan makeBuildPlan(const core::GridPlan& grid) {
  BuildPlan plan{};
  plan.grid = grid;
  plan.grid_levels.count = grid.view.grid_levels;
  for (int t = 0; t < grid.view.grid_levels; ++t) {
    plan.grid_levels.of[t] = core::makeGridLevel(grid, t);
    plan.grid_levels.first[t + 1] = plan.grid_levels.first[t] + plan.grid_levels.of[t].count;
  }
  ListTasks& tasks = plan.list_tasks;
  constexpr double kMostNear = 1 << 21;  // beyond that slices grow
  for (int above = 0; above < grid.levels; ++above)
    tasks.cells_near[above] = static_cast<unsigned>(std::min(cellsNear(above), kMostNear));
  unsigned clusters[core::kMostLevels] = {}, before = 0;
  for (int level = 0; level < grid.levels; ++level) {
    const unsigned spheres = grid.level_first[level + 1] - grid.level_first[level];
    const int bits = std::min(3 * grid.curve_bits, static_cast<int>(std::bit_width(spheres)));
    plan.buckets.first[level] = plan.buckets.all;
    plan.buckets.shift[level] = 3 * grid.curve_bits - bits;
    plan.buckets.all += 1u << bits;
    tasks.in_cluster[level] = std::min(spheres, core::kClusterSize);
    clusters[level] = (spheres + core::kClusterSize - 1) / core::kClusterSize;
    if (spheres > 0 && cellsNear(grid.levelsAbove(level, 0)) >= 0x1p31)
      throw Error(ErrorCode::bad_argument, "the spheres differ too much in size for a device; use fewer");
    tasks.first_cluster[level] = before;
    before += clusters[level];
    for (int t = 0; t < grid.view.grid_levels && grid.levelsAbove(level, t) >= 0; ++t)
      tasks.of_cluster[level] += tasks.slices(level, grid.levelsAbove(level, t));
  }
  for (int level = grid.levels - 1; level >= 0; --level) {
    tasks.all += clusters[level] * tasks.of_cluster[level];
    tasks.end[level] = tasks.all;
  }
  return plan;
}

void CudaGrid::build(const Sphere* spheres, const core::GridPlan& grid, cudaStream_t stream) {
  const std::uint32_t count = grid.view.count;
  const bool first = !header_.data();
  if (!scratch_) scratch_ = std::make_unique<BuildScratch>();
  const Sphere* const given = onDevice(spheres, count, stream);
  header_.reserve(1);
  if (first)  // kernels copy it as a whole, with its gaps
    INNERSPHERE_CUDA(cudaMemsetAsync(header_.data(), 0, sizeof(Grid), stream));
  spheres_.reserve(count);
  ids_.reserve(count);
  places_.reserve(count);
  clusters_.reserve(grid.view.cluster_count);
  groups_.reserve(groupCount(grid.view.cluster_count));
  const BuildPlan plan = makeBuildPlan(grid);
  const bool dense = isDense(plan);
  launchBuild(plan, arrays(), given, {true, dense}, *scratch_, stream);
  if (!dense || !finish(plan, stream)) {
    const BuildStatus status = sortLists(plan, arrays(), *scratch_, stream);
    makeRoom(status, count, stream);
    launchSorted(plan, arrays(), status, *scratch_, stream);
    INNERSPHERE_CUDA(cudaStreamSynchronize(stream));
  }
  if (first) scratch_.reset();
}

const Sphere* CudaGrid::onDevice(const Sphere* spheres, std::size_t count, cudaStream_t stream) {
  cudaPointerAttributes attributes{};
  INNERSPHERE_CUDA(cudaPointerGetAttributes(&attributes, spheres));
  if (attributes.type == cudaMemoryTypeDevice && attributes.device == device_) return spheres;
  scratch_->given.reserve(count);
  copyAsync(scratch_->given.data(), spheres, count, stream);
  return scratch_->given.data();
}

/// False if some list is too long for it.
bool CudaGrid::finish(const BuildPlan& plan, cudaStream_t stream) {
  while (true) {
    INNERSPHERE_CUDA(cudaStreamSynchronize(stream));
    const BuildStatus status = *scratch_->status.data();
    if (status.longest > kLongestInOrder) return false;
    if (fits(status, arrays())) return true;
    makeRoom(status, plan.grid.view.count, stream);
    launchBuild(plan, arrays(), nullptr, {false, true}, *scratch_, stream);
  }
}

/// The first time just enough, then with room to grow; with an empty table.
void CudaGrid::makeRoom(const BuildStatus& status, std::uint32_t spheres, cudaStream_t stream) {
  if (status.listed >> 32 != 0)
    throw Error(ErrorCode::bad_argument, "the spheres fill more than 2^32 places in the grid; use fewer");
  if (listed_.capacity() < status.listed) {
    const std::uint64_t room = status.listed + (listed_.capacity() > 0 ? status.listed / 4 : 0);
    entries_.reserve(room / 2 + entriesOfAll(spheres));
    listed_.reserve(room);  // last: its capacity stands for both, also where memory does not suffice
  }
  cells_.reserve(tableSizeFor(status.cells));
  INNERSPHERE_CUDA(cudaMemsetAsync(cells_.data(), 0xff, cells_.capacity() * sizeof(core::Cell), stream));
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
