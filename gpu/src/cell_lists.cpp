#include "cell_lists.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace innersphere {

using core::Vec3f;

namespace {

/// Numbers keys in the order in which they come.
class KeyNumbers {
 public:
  explicit KeyNumbers(std::size_t expected) { resize(std::bit_ceil(2 * expected + 2)); }

  std::uint32_t numberOf(std::uint64_t key) {
    std::size_t at = place(key);
    for (; slots_[at] != kNone; at = (at + 1) & mask_) {
      if (keys[slots_[at]] == key) return slots_[at];
    }
    const auto number = static_cast<std::uint32_t>(keys.size());
    slots_[at] = number;
    keys.push_back(key);
    if (2 * keys.size() > slots_.size()) resize(2 * slots_.size());
    return number;
  }

  std::vector<std::uint64_t> keys;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::size_t place(std::uint64_t key) const {
    return static_cast<std::size_t>(key * 0x9e3779b97f4a7c15u >> shift_);
  }

  void resize(std::size_t size) {
    slots_.assign(size, kNone);
    mask_ = size - 1;
    shift_ = 64 - std::countr_zero(size);
    for (std::uint32_t number = 0; number < keys.size(); ++number) {
      std::size_t at = place(keys[number]);
      while (slots_[at] != kNone) at = (at + 1) & mask_;
      slots_[at] = number;
    }
  }

  std::vector<std::uint32_t> slots_;
  std::size_t mask_ = 0;
  int shift_ = 0;
};

/// Squared distance from x to the cell number `cell` of an axis.
float gap2(float x, std::uint32_t cell, float edge) {
  const float lo = (static_cast<float>(cell) - 1) * edge;
  const float d = std::max(std::max(lo - x, x - (lo + edge)), 0.0f);
  return d * d;
}

/// Calls f(key) for all cells of a tier that list the sphere.
template <typename F>
void forCells(const core::GridView& grid, int tier, const Sphere& s, const F& f) {
  const float edge = core::powerOfTwo(grid.finest + tier);
  const float reach = s.radius + core::reachOf(grid, tier), reach2 = reach * reach;
  const Vec3f p{s.x + grid.half.x, s.y + grid.half.y, s.z + grid.half.z};
  core::CellBox box{};
  [[maybe_unused]] const bool inside = core::cellBox(grid, tier, {s.x - reach, s.y - reach, s.z - reach},
                                                     {s.x + reach, s.y + reach, s.z + reach}, box);
  assert(inside);
  for (std::uint32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
    const float gap_z = gap2(p.z, z, edge);
    for (std::uint32_t y = box.lo[1]; y <= box.hi[1]; ++y) {
      const float gap_zy = gap_z + gap2(p.y, y, edge);
      if (gap_zy > reach2) continue;
      for (std::uint32_t x = box.lo[0]; x <= box.hi[0]; ++x) {
        if (!(gap_zy + gap2(p.x, x, edge) > reach2)) f(core::cellKey(tier, x, y, z));
      }
    }
  }
}

}  // namespace

CellLists listCells(const core::GridView& grid, const std::function<std::uint32_t(int)>& firstPlace) {
  struct Entry {
    std::uint32_t cell, place;
  };
  KeyNumbers numbers(grid.count);
  std::vector<Entry> entries;
  entries.reserve(std::size_t{8} * grid.count);
  for (int tier = 0; tier < grid.tiers; ++tier) {
    for (std::uint32_t place = firstPlace(tier); place < grid.count; ++place)
      forCells(grid, tier, grid.centred[place], [&](std::uint64_t key) {
        entries.push_back({numbers.numberOf(key), place});
      });
  }
  std::vector<core::Cell> cells(numbers.keys.size());
  for (const Entry& entry : entries) ++cells[entry.cell].count;
  std::uint32_t listed = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    cells[c].key = numbers.keys[c];
    cells[c].first = listed;
    listed += (cells[c].count + core::kListStep - 1) / core::kListStep * core::kListStep;
  }
  CellLists lists;
  lists.listed.assign(listed, grid.count);
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
