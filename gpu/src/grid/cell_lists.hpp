// Makes the cells of a grid and what they list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/grid_level.hpp"

namespace innersphere {

/// Holds a grid's cells and their lists. The lists come by rising key. The table has open addressing, and
/// cells with smaller keys were there first: so both depend on nothing but the cells, in whatever order these
/// are found.
struct CellLists {
  static constexpr std::uint32_t kPastEnd = 16;  ///< so many places behind the last list may be read, too

  std::vector<core::Cell> table;      ///< at most half full
  std::vector<std::uint32_t> listed;  ///< places, rising in each cell; see GridView::listed
  int hash_shift = 0;
};

/// Makes the lists of a grid: counts what each cell will list, sums that up to where its list begins, and
/// fills. Keeps its memory for the next grid.
class CellLister {
 public:
  /// Lists each sphere in all cells where a query sphere can meet it: those of each grid level that are not
  /// farther from its centre than its radius and the reach of the grid level's query spheres. `centred` are
  /// the spheres in the order of the grid, relative to its centre.
  void list(const core::GridPlan& plan, const Sphere* centred, CellLists& lists);

 private:
  /// Says that a cell of a grid level lists a sphere.
  struct DenseEntry {
    std::uint32_t cell;
    std::uint32_t place;
  };
  struct SparseEntry {
    std::uint64_t cell;
    std::uint32_t place;
  };

  /// This is a vector that does not write to memory before its entries are.
  template <typename Entry>
  struct Entries {
    std::unique_ptr<Entry[]> items;
    std::size_t count = 0, capacity = 0;

    void clear(std::size_t expected) {
      count = 0;
      if (capacity < expected) grow(expected);
    }
    /// Returns where the next ones go, up to `more` of them.
    Entry* room(std::size_t more) {
      if (count + more > capacity) grow(2 * (count + more));
      return items.get() + count;
    }
    void grow(std::size_t size) {
      std::unique_ptr<Entry[]> larger(new Entry[size]);
      std::copy_n(items.get(), count, larger.get());
      items = std::move(larger);
      capacity = size;
    }
  };

  template <typename Entry>
  static void addCells(const core::GridLevel& grid_level, const Sphere& sphere, std::uint32_t place,
                       Entries<Entry>& entries);
  void listDense(const core::GridLevel& grid_level, std::uint32_t count, const Sphere* centred,
                 std::vector<std::uint32_t>& listed);
  void listSparse(const core::GridLevel& grid_level, std::uint32_t count, const Sphere* centred,
                  std::vector<std::uint32_t>& listed);
  void fillTable(CellLists& lists) const;

  std::vector<core::Cell> cells_;
  std::vector<std::uint32_t> counts_;       ///< of each chunk, of each cell; later where its next place goes
  std::vector<Entries<DenseEntry>> dense_;  ///< of each chunk
  Entries<SparseEntry> sparse_, spare_;
};

}  // namespace innersphere
