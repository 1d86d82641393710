#include "cell_lists.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "digit_sort.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

using core::Vec3f;

namespace {

/// Squared distance from x to the cell number `cell` of an axis, in cells; without a branch.
float gap2(float x, std::uint32_t cell) {
  const float middle =
      static_cast<float>(static_cast<std::int32_t>(cell)) - 0.5f;  // number 0 is before the first
  const float outside = std::fabs(x - middle) - 0.5f;
  const float gap = 0.5f * (outside + std::fabs(outside));
  return gap * gap;
}

/// Room for a list, in whole steps.
std::uint32_t padded(std::uint32_t count) {
  return (count + core::kListStep - 1) / core::kListStep * core::kListStep;
}

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

/// The cells of a tier, numbered along x, then y, then z: by their keys.
struct CellLister::Tier {
  const core::GridView& grid;
  int number;
  std::uint32_t first_place;
  std::array<std::uint32_t, 3> size{};
  std::uint64_t cells = 1;
  float scale;  ///< cells in a metre: squares of lengths in cells are neither too small nor too large
  float reach;  ///< of walkers, in cells

  Tier(const core::GridView& view, int tier, std::uint32_t first)
      : grid(view),
        number(tier),
        first_place(first),
        scale(core::powerOfTwo(-(view.finest + tier))),
        reach(core::reachOf(view, tier) * scale) {
    constexpr float kMax = std::numeric_limits<float>::max();
    core::CellBox all{};
    core::cellBox(grid, number, {-kMax, -kMax, -kMax}, {kMax, kMax, kMax}, all);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      size[axis] = all.hi[axis] + 1;
      cells *= size[axis];
    }
  }

  std::uint64_t key(std::uint64_t cell) const {
    const std::uint64_t row = cell / size[0];
    return core::cellKey(number, static_cast<std::uint32_t>(cell % size[0]),
                         static_cast<std::uint32_t>(row % size[1]),
                         static_cast<std::uint32_t>(row / size[1]));
  }

  /// Adds an entry for each cell that lists the sphere: those with a point that is not farther away than
  /// `far`, by the squares of three gaps, added up in this order.
  template <typename Entry>
  void addCells(std::uint32_t place, Entries<Entry>& entries) const {
    const Sphere& s = grid.centred[place];
    const float far = s.radius * scale + reach, far2 = far * far;
    const float centre[3] = {(s.x + grid.half.x) * scale, (s.y + grid.half.y) * scale,
                             (s.z + grid.half.z) * scale};
    std::uint32_t lo[3], hi[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = static_cast<std::uint32_t>(std::max(centre[axis] - far + 1, 0.0f));
      hi[axis] = std::min(static_cast<std::uint32_t>(centre[axis] + far + 1), size[axis] - 1);
    }
    using Cell = decltype(Entry::cell);
    const auto cellAt = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
      return (static_cast<Cell>(z) * size[1] + y) * size[0] + x;
    };
    if (hi[0] - lo[0] < 2 && hi[1] - lo[1] < 2 && hi[2] - lo[2] < 2) {  // as most are: no branches
      constexpr float kOutside = std::numeric_limits<float>::infinity();
      float gaps[3][2];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        gaps[axis][0] = gap2(centre[axis], lo[axis]);
        gaps[axis][1] = hi[axis] > lo[axis] ? gap2(centre[axis], hi[axis]) : kOutside;
      }
      Entry* to = entries.room(8);
      const Cell first = cellAt(lo[0], lo[1], lo[2]);
      const Cell steps[3] = {1, size[0], static_cast<Cell>(size[0]) * size[1]};
      for (std::size_t z = 0; z < 2; ++z) {
        for (std::size_t y = 0; y < 2; ++y) {
          for (std::size_t x = 0; x < 2; ++x) {
            const bool far_away = gaps[2][z] + gaps[1][y] + gaps[0][x] > far2;
            *to = {static_cast<Cell>(first + z * steps[2] + y * steps[1] + x * steps[0]), place};
            to += far_away ? 0 : 1;
          }
        }
      }
      entries.count = static_cast<std::size_t>(to - entries.items.get());
      return;
    }
    for (std::uint32_t z = lo[2]; z <= hi[2]; ++z) {
      const float gap_z = gap2(centre[2], z);
      for (std::uint32_t y = lo[1]; y <= hi[1]; ++y) {
        const float gap_zy = gap_z + gap2(centre[1], y);
        Entry* const to = entries.room(hi[0] - lo[0] + 1);
        std::size_t count = 0;
        for (std::uint32_t x = lo[0]; x <= hi[0]; ++x) {
          to[count] = {cellAt(x, y, z), place};
          count += gap_zy + gap2(centre[0], x) > far2 ? 0 : 1;
        }
        entries.count += count;
      }
    }
  }
};

void CellLister::list(const core::GridView& grid, const std::vector<std::uint32_t>& first_places,
                      CellLists& lists) {
  cells_.clear();
  lists.listed.clear();
  for (int number = 0; number < grid.tiers; ++number) {
    const Tier tier(grid, number, first_places[static_cast<std::size_t>(number)]);
    const bool dense = tier.cells <= std::min(64 + std::uint64_t{8} * grid.count, std::uint64_t{1} << 31);
    dense ? listDense(tier, lists.listed) : listSparse(tier, lists.listed);
  }
  enlarge(lists.listed, lists.listed.size() + CellLists::kPastEnd, grid.count);
  fillTable(grid, lists);
}

/// Chunks of spheres count and fill side by side. A cell's list has what comes from the first chunk first, so
/// it is the same for any number of them.
void CellLister::listDense(const Tier& tier, std::vector<std::uint32_t>& listed) {
  constexpr std::uint32_t kChunk = 8192;  // spheres, at least
  const std::uint32_t spheres = tier.grid.count - tier.first_place;
  const auto threads = static_cast<std::uint32_t>(tbb::this_task_arena::max_concurrency());
  const std::uint32_t chunks = std::clamp(spheres / kChunk, 1u, std::clamp(threads, 1u, 16u));
  if (dense_.size() < chunks) dense_.resize(chunks);
  counts_.clear();
  enlarge(counts_, chunks * tier.cells, 0u);
  const auto placeAt = [&](std::uint32_t chunk) {
    return tier.first_place + static_cast<std::uint32_t>(std::uint64_t{spheres} * chunk / chunks);
  };
  const auto forChunks = [&](const auto& f) {
    if (chunks == 1) return f(0u);
    tbb::parallel_for(0u, chunks, f);
  };

  forChunks([&](std::uint32_t chunk) {
    Entries<DenseEntry>& entries = dense_[chunk];
    entries.clear(std::size_t{9} * (placeAt(chunk + 1) - placeAt(chunk)));
    for (std::uint32_t place = placeAt(chunk); place < placeAt(chunk + 1); ++place)
      tier.addCells(place, entries);
    std::uint32_t* const counts = counts_.data() + chunk * tier.cells;
    for (std::size_t e = 0; e < entries.count; ++e) ++counts[entries.items[e].cell];
  });

  std::uint64_t end = listed.size();
  for (std::uint64_t cell = 0; cell < tier.cells; ++cell) {
    std::uint32_t count = 0;
    for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
      std::uint32_t& of_chunk = counts_[chunk * tier.cells + cell];
      const auto next = static_cast<std::uint32_t>(end + count);
      count += of_chunk;
      of_chunk = next;
    }
    if (count == 0) continue;
    cells_.push_back({tier.key(cell), static_cast<std::uint32_t>(end), count});
    end += padded(count);
    checkSize(end);
  }
  enlarge(listed, end, tier.grid.count);

  forChunks([&](std::uint32_t chunk) {
    std::uint32_t* const next = counts_.data() + chunk * tier.cells;
    const Entries<DenseEntry>& entries = dense_[chunk];
    for (std::size_t e = 0; e < entries.count; ++e)
      listed[next[entries.items[e].cell]++] = entries.items[e].place;
  });
}

void CellLister::listSparse(const Tier& tier, std::vector<std::uint32_t>& listed) {
  sparse_.clear(std::size_t{9} * (tier.grid.count - tier.first_place));
  for (std::uint32_t place = tier.first_place; place < tier.grid.count; ++place)
    tier.addCells(place, sparse_);
  const std::size_t count = sparse_.count;
  checkSize(listed.size() + std::uint64_t{core::kListStep} * count);
  spare_.clear(count);
  const int bits = std::bit_width(tier.cells - 1);
  SparseEntry *sorted = sparse_.items.get(), *spare = spare_.items.get();
  sortByBits(
      sorted, spare, count, [](const SparseEntry& entry) { return entry.cell; }, 0, bits);
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    const auto first = static_cast<std::uint32_t>(listed.size());
    for (; end < count && sorted[end].cell == sorted[begin].cell; ++end) listed.push_back(sorted[end].place);
    const auto length = static_cast<std::uint32_t>(end - begin);
    cells_.push_back({tier.key(sorted[begin].cell), first, length});
    listed.resize(first + padded(length), tier.grid.count);
  }
}

void CellLister::fillTable(const core::GridView& grid, CellLists& lists) const {
  lists.table.clear();
  enlarge(lists.table, std::bit_ceil(2 * cells_.size()), core::Cell{});
  lists.hash_shift = 64 - std::countr_zero(lists.table.size());
  core::GridView view = grid;
  view.hash_shift = lists.hash_shift;
  const std::size_t mask = lists.table.size() - 1;
  for (const core::Cell& cell : cells_) {
    std::size_t at = core::hashCell(view, cell.key);
    while (lists.table[at].count != 0) at = (at + 1) & mask;
    lists.table[at] = cell;
  }
}

}  // namespace innersphere
