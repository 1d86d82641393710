#include "cell_lists.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace innersphere {

using core::Vec3f;

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

core::CellBox allCells(const core::GridView& grid, int tier) {
  constexpr float kMax = std::numeric_limits<float>::max();
  core::CellBox all{};
  core::cellBox(grid, tier, {-kMax, -kMax, -kMax}, {kMax, kMax, kMax}, all);
  return all;
}

/// Numbers the cells of a tier in the order in which they come: through a table of all of them where they are
/// not many more than the spheres, otherwise through a hash table.
class CellNumbers {
 public:
  /// New cells are appended to `keys`.
  CellNumbers(const core::GridView& grid, int tier, const core::CellBox& all,
              std::vector<std::uint64_t>& keys)
      : tier_(tier), keys_(keys) {
    std::uint64_t cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      size_[axis] = all.hi[axis] + 1;
      cells *= size_[axis];
    }
    dense_ = cells <= 64 + std::uint64_t{8} * grid.count;
    begin_ = keys_.size();
    if (dense_) {
      numbers_.assign(cells, kNone);
    } else {
      resize(std::bit_ceil(std::size_t{grid.count} + 2));
    }
  }

  std::uint32_t numberOf(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    if (dense_) {
      std::uint32_t& number = numbers_[(std::size_t{z} * size_[1] + y) * size_[0] + x];
      if (number == kNone) number = append(core::cellKey(tier_, x, y, z));
      return number;
    }
    const std::uint64_t key = core::cellKey(tier_, x, y, z);
    std::size_t at = place(key);
    for (; numbers_[at] != kNone; at = (at + 1) & mask_) {
      if (keys_[numbers_[at]] == key) return numbers_[at];
    }
    const std::uint32_t number = numbers_[at] = append(key);
    if (2 * (keys_.size() - begin_) > numbers_.size()) resize(2 * numbers_.size());
    return number;
  }

 private:
  std::uint32_t append(std::uint64_t key) {
    keys_.push_back(key);
    return static_cast<std::uint32_t>(keys_.size() - 1);
  }

  std::size_t place(std::uint64_t key) const {
    return static_cast<std::size_t>(key * 0x9e3779b97f4a7c15u >> shift_);
  }

  void resize(std::size_t size) {
    numbers_.assign(size, kNone);
    mask_ = size - 1;
    shift_ = 64 - std::countr_zero(size);
    for (std::size_t number = begin_; number < keys_.size(); ++number) {
      std::size_t at = place(keys_[number]);
      while (numbers_[at] != kNone) at = (at + 1) & mask_;
      numbers_[at] = static_cast<std::uint32_t>(number);
    }
  }

  int tier_;
  bool dense_;
  std::array<std::uint32_t, 3> size_;
  std::size_t begin_;  ///< of this tier's keys
  std::vector<std::uint64_t>& keys_;
  std::vector<std::uint32_t> numbers_;
  std::size_t mask_ = 0;
  int shift_ = 0;
};

/// Squared distance from x to the cell number `cell` of an axis, in cells.
float gap2(float x, std::uint32_t cell) {
  const float lo = static_cast<float>(cell) - 1;
  const float d = std::max(std::max(lo - x, x - (lo + 1)), 0.0f);
  return d * d;
}

/// Calls f(x, y, z) for all cells of a tier that list the sphere. `all` are those of the tier.
template <typename F>
void forCells(const core::GridView& grid, int tier, const core::CellBox& all, const Sphere& s, const F& f) {
  // In cells, so that squares are neither too small nor too large for a number.
  const float scale = core::powerOfTwo(-(grid.finest + tier));
  const float reach = (s.radius + core::reachOf(grid, tier)) * scale, reach2 = reach * reach;
  const Vec3f p{(s.x + grid.half.x) * scale, (s.y + grid.half.y) * scale, (s.z + grid.half.z) * scale};
  core::CellBox box;
  const float centre[3] = {p.x, p.y, p.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {  // cells are numbered from one before the first
    box.lo[axis] = static_cast<std::uint32_t>(std::max(centre[axis] - reach + 1, 0.0f));
    box.hi[axis] = std::min(static_cast<std::uint32_t>(centre[axis] + reach + 1), all.hi[axis]);
  }
  for (std::uint32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
    const float gap_z = gap2(p.z, z);
    for (std::uint32_t y = box.lo[1]; y <= box.hi[1]; ++y) {
      const float left = reach2 - (gap_z + gap2(p.y, y));
      if (left < 0) continue;
      const float wide = std::sqrt(left);
      const auto first = static_cast<std::uint32_t>(std::max(p.x - wide + 1, 0.0f));
      const std::uint32_t last = std::min(box.hi[0], static_cast<std::uint32_t>(p.x + wide + 1));
      for (std::uint32_t x = std::max(box.lo[0], first); x <= last; ++x) f(x, y, z);
    }
  }
}

}  // namespace

CellLists listCells(const core::GridView& grid, const std::function<std::uint32_t(int)>& firstPlace) {
  struct Entry {
    std::uint32_t cell, place;
  };
  std::vector<std::uint64_t> keys;
  std::vector<Entry> entries;
  entries.reserve(std::size_t{8} * grid.count);
  for (int tier = 0; tier < grid.tiers; ++tier) {
    const core::CellBox all = allCells(grid, tier);
    CellNumbers numbers(grid, tier, all, keys);
    for (std::uint32_t place = firstPlace(tier); place < grid.count; ++place)
      forCells(grid, tier, all, grid.centred[place], [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        entries.push_back({numbers.numberOf(x, y, z), place});
      });
  }
  std::vector<core::Cell> cells(keys.size());
  for (const Entry& entry : entries) ++cells[entry.cell].count;
  std::uint32_t listed = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    cells[c].key = keys[c];
    cells[c].first = listed;
    listed += (cells[c].count + core::kListStep - 1) / core::kListStep * core::kListStep;
  }
  CellLists lists;
  lists.listed.assign(listed + CellLists::kPastEnd, grid.count);
  std::vector<std::uint32_t> next(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) next[c] = cells[c].first;
  for (const Entry& entry : entries) lists.listed[next[entry.cell]++] = entry.place;

  lists.table.assign(std::bit_ceil(2 * cells.size()), core::Cell{});
  lists.hash_shift = 64 - std::countr_zero(lists.table.size());
  core::GridView view = grid;
  view.hash_shift = lists.hash_shift;
  for (const core::Cell& cell : cells) {
    std::size_t at = core::hashCell(view, cell.key);
    while (lists.table[at].count != 0) at = (at + 1) & (lists.table.size() - 1);
    lists.table[at] = cell;
  }
  return lists;
}

}  // namespace innersphere
