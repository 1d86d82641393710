// The cells of a grid and what they list.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/grid_view.hpp"

namespace innersphere {

struct CellLists {
  static constexpr std::uint32_t kPastEnd = 16;  ///< so many places behind the last list may be read, too

  std::vector<core::Cell> table;      ///< at most half full
  std::vector<std::uint32_t> listed;  ///< places, rising in each cell; see GridView::listed
  int hash_shift = 0;
};

/// Lists each sphere in all cells where a walker can meet it: those of each tier that are not farther from
/// its centre than its radius and the reach of the tier's walkers. The spheres of a tier are those from
/// firstPlace(tier) on. Of `grid`, all but the cells must be there.
CellLists listCells(const core::GridView& grid, const std::function<std::uint32_t(int)>& firstPlace);

}  // namespace innersphere
