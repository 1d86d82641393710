// Packs greedily, in rounds.
#pragma once

#include <tbb/task_arena.h>

#include <functional>
#include <vector>

#include "packer/cell_search.hpp"

namespace innersphere {

/// Inserts spheres greedily, in rounds. A round starts from the certainty that no sphere larger than `top`
/// fits. It inserts spheres larger than top / (1 + delta), until no sphere larger than `bound` fits, a little
/// above that; this is the next round's top. All blocks of the octree that may hold such a sphere are
/// searched in parallel. Of candidates that overlap, the larger one wins, or the one that comes first along
/// the Z-order curve, so the result does not depend on threads.
class GreedyRounds {
 public:
  /// Holds what has been placed, in the order of placing.
  struct Placed {
    SphereGrid grid;
    std::vector<Ball> rounded;  ///< the balls as they are stored
    std::vector<float> top;     ///< for each ball: nothing larger was possible when it was placed
    float largest_missing = 0;  ///< nothing larger is possible now
  };

  /// The cells that are live at once, at most, and for each sphere as many more: 3 GB.
  static constexpr std::size_t kMostCells = std::size_t{1} << 25, kMostCellsPerSphere = 256;

  /// `most`: how many spheres are wanted in all.
  GreedyRounds(const Container& container, double delta, double min_radius, std::size_t most,
               std::size_t most_cells = kMostCells)
      : container_(container), delta_(delta), min_radius_(min_radius), most_(most), most_cells_(most_cells) {}

  using Stop = std::function<bool(const Placed&)>;
  using Pause = std::function<bool(const Placed&, double)>;
  using Add = std::function<bool(Placed&, double)>;

  /// Packs. `stop` is called after every sphere; `pause` is called with the bound between the parallel
  /// searches, and it may throw; `add`, which may be null, is called after every sphere with the radius that
  /// none can exceed, and may insert spheres of its own. All are called from this thread and end the packing
  /// by returning true. The searches run in `arena`. Throws Error bad_argument if more cells are live than
  /// may be.
  Placed run(tbb::task_arena& arena, const Stop& stop, const Pause& pause, const Add& add) const;

  /// This is a cell to be searched, and the block of the octree that it is in.
  struct Active {
    std::uint64_t block;
    Cell cell;
  };

 private:
  struct Round;
  struct Found;

  /// Searches the cells, which are in the order of blocks, in parallel: first those of a part of the blocks,
  /// spread over the solid, and then the others, unless that part has given too many candidates.
  Found search(const std::vector<Active>& active, const Round& round, std::uint64_t turn,
               const SphereGrid& grid) const;
  /// Inserts the candidates that do not overlap what was placed before them. Returns true if `stop` or `add`
  /// say so.
  bool insert(const std::vector<CellSearch::Candidate>& candidates, float top, const Stop& stop,
              const Add& add, Placed& placed) const;

  const Container& container_;
  double delta_;
  double min_radius_;
  std::size_t most_, most_cells_;
};

}  // namespace innersphere
