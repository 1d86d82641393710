#include "grid/cell_lists.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "common/radix_sort.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

using core::GridLevel;

namespace {

/// Places in the lists have 32 bits.
void checkSize(std::uint64_t listed) {
  if ((listed + CellLists::kPastEnd) >> 32 != 0)
    throw Error(ErrorCode::bad_argument, "the spheres fill more than 2^32 places in the grid; use fewer");
}

/// Makes a vector larger, with room to grow: its size may be a little different each time.
template <typename T>
void enlarge(std::vector<T>& items, std::size_t size, const T& value) {
  if (items.capacity() < size) items.reserve(size + size / 4);
  items.resize(size, value);
}

}  // namespace

/// Adds an entry for each cell of the grid level that lists the sphere.
template <typename Entry>
void CellLister::addCells(const GridLevel& grid_level, const Sphere& sphere, std::uint32_t place,
                          Entries<Entry>& entries) {
  const core::CellsNear near = grid_level.near(sphere);
  const auto &lo = near.lo, &hi = near.hi;
  using Cell = decltype(Entry::cell);
  const auto cellAt = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return static_cast<Cell>(grid_level.cellAt(x, y, z));
  };
  if (hi[0] - lo[0] < 2 && hi[1] - lo[1] < 2 && hi[2] - lo[2] < 2) {  // as most are: no branches
    constexpr float kOutside = std::numeric_limits<float>::infinity();
    float gaps[3][2];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      gaps[axis][0] = core::gap2(near.centre[axis], lo[axis]);
      gaps[axis][1] = hi[axis] > lo[axis] ? core::gap2(near.centre[axis], hi[axis]) : kOutside;
    }
    Entry* to = entries.room(8);
    const Cell first = cellAt(lo[0], lo[1], lo[2]);
    const Cell steps[3] = {1, grid_level.size[0], static_cast<Cell>(grid_level.size[0]) * grid_level.size[1]};
    for (std::size_t z = 0; z < 2; ++z) {
      for (std::size_t y = 0; y < 2; ++y) {
        for (std::size_t x = 0; x < 2; ++x) {
          const bool far_away = gaps[2][z] + gaps[1][y] + gaps[0][x] > near.far2;
          *to = {static_cast<Cell>(first + z * steps[2] + y * steps[1] + x * steps[0]), place};
          to += far_away ? 0 : 1;
        }
      }
    }
    entries.count = static_cast<std::size_t>(to - entries.items.get());
    return;
  }
  for (std::uint32_t z = lo[2]; z <= hi[2]; ++z) {
    for (std::uint32_t y = lo[1]; y <= hi[1]; ++y) {
      const float gap_zy = core::gap2(near.centre[2], z) + core::gap2(near.centre[1], y);
      Entry* const to = entries.room(hi[0] - lo[0] + 1);
      std::size_t count = 0;
      for (std::uint32_t x = lo[0]; x <= hi[0]; ++x) {
        to[count] = {cellAt(x, y, z), place};
        count += gap_zy + core::gap2(near.centre[0], x) > near.far2 ? 0 : 1;
      }
      entries.count += count;
    }
  }
}

void CellLister::list(const core::GridPlan& plan, const Sphere* centred, CellLists& lists) {
  cells_.clear();
  lists.listed.clear();
  const core::GridView& view = plan.view;
  for (int number = 0; number < view.grid_levels; ++number) {
    const GridLevel grid_level = core::makeGridLevel(plan, number);
    const bool dense = core::isDense(grid_level, view.count);
    (this->*(dense ? &CellLister::listDense : &CellLister::listSparse))(grid_level, view.count, centred,
                                                                        lists.listed);
  }
  enlarge(lists.listed, lists.listed.size() + CellLists::kPastEnd, view.count);
  fillTable(lists);
}

/// Chunks of spheres count and fill side by side. A cell's list has what comes from the first chunk first, so
/// it is the same for any number of them.
void CellLister::listDense(const GridLevel& grid_level, std::uint32_t count, const Sphere* centred,
                           std::vector<std::uint32_t>& listed) {
  constexpr std::uint32_t kChunk = 8192;  // spheres, at least
  const std::uint32_t spheres = count - grid_level.first_place;
  const auto threads = static_cast<std::uint32_t>(tbb::this_task_arena::max_concurrency());
  const std::uint32_t chunks = std::clamp(spheres / kChunk, 1u, std::clamp(threads, 1u, 16u));
  if (dense_.size() < chunks) dense_.resize(chunks);
  counts_.clear();
  enlarge(counts_, chunks * grid_level.count, 0u);
  const auto placeAt = [&](std::uint32_t chunk) {
    return grid_level.first_place + static_cast<std::uint32_t>(std::uint64_t{spheres} * chunk / chunks);
  };
  const auto forChunks = [&](const auto& f) {
    if (chunks == 1) return f(0u);
    tbb::parallel_for(0u, chunks, f);
  };

  forChunks([&](std::uint32_t chunk) {
    Entries<DenseEntry>& entries = dense_[chunk];
    entries.clear(std::size_t{9} * (placeAt(chunk + 1) - placeAt(chunk)));
    for (std::uint32_t place = placeAt(chunk); place < placeAt(chunk + 1); ++place)
      addCells(grid_level, centred[place], place, entries);
    std::uint32_t* const counts = counts_.data() + chunk * grid_level.count;
    for (std::size_t e = 0; e < entries.count; ++e) ++counts[entries.items[e].cell];
  });

  std::uint64_t end = listed.size();
  for (std::uint64_t cell = 0; cell < grid_level.count; ++cell) {
    std::uint32_t length = 0;
    for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
      std::uint32_t& of_chunk = counts_[chunk * grid_level.count + cell];
      const auto next = static_cast<std::uint32_t>(end + length);
      length += of_chunk;
      of_chunk = next;
    }
    if (length == 0) continue;
    cells_.push_back({grid_level.keyOf(cell), static_cast<std::uint32_t>(end), length});
    end += core::padded(length);
    checkSize(end);
  }
  enlarge(listed, end, count);

  forChunks([&](std::uint32_t chunk) {
    std::uint32_t* const next = counts_.data() + chunk * grid_level.count;
    const Entries<DenseEntry>& entries = dense_[chunk];
    for (std::size_t e = 0; e < entries.count; ++e)
      listed[next[entries.items[e].cell]++] = entries.items[e].place;
  });
}

void CellLister::listSparse(const GridLevel& grid_level, std::uint32_t count, const Sphere* centred,
                            std::vector<std::uint32_t>& listed) {
  sparse_.clear(std::size_t{9} * (count - grid_level.first_place));
  for (std::uint32_t place = grid_level.first_place; place < count; ++place)
    addCells(grid_level, centred[place], place, sparse_);
  const std::size_t entries = sparse_.count;
  checkSize(listed.size() + std::uint64_t{core::kListStep} * entries);
  spare_.clear(entries);
  const int bits = std::bit_width(grid_level.count - 1);
  SparseEntry *sorted = sparse_.items.get(), *spare = spare_.items.get();
  sortByBits(
      sorted, spare, entries, [](const SparseEntry& entry) { return entry.cell; }, 0, bits);
  for (std::size_t begin = 0, end = 0; begin < entries; begin = end) {
    const auto first = static_cast<std::uint32_t>(listed.size());
    for (; end < entries && sorted[end].cell == sorted[begin].cell; ++end)
      listed.push_back(sorted[end].place);
    const auto length = static_cast<std::uint32_t>(end - begin);
    cells_.push_back({grid_level.keyOf(sorted[begin].cell), first, length});
    listed.resize(first + core::padded(length), count);
  }
}

void CellLister::fillTable(CellLists& lists) const {
  lists.table.clear();
  enlarge(lists.table, std::bit_ceil(2 * cells_.size()), core::Cell{});
  lists.hash_shift = 64 - std::countr_zero(lists.table.size());
  core::GridView view{};
  view.hash_shift = lists.hash_shift;
  const std::size_t mask = lists.table.size() - 1;
  for (const core::Cell& cell : cells_) {
    std::size_t at = core::hashCell(view, cell.key);
    while (lists.table[at].count != 0) at = (at + 1) & mask;
    lists.table[at] = cell;
  }
}

}  // namespace innersphere
