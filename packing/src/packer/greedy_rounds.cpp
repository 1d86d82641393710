#include "packer/greedy_rounds.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

#include "common/steady_math.hpp"

namespace innersphere {
namespace {

// The first spheres decide most of the density and cost little: they are placed with a tight delta.
constexpr std::size_t kTightSpheres = 300;
constexpr double kTightDelta = 0.01;

// Unless this many cells would have to be looked at in one round: many places are about equally good, and
// proofs with a tight delta are expensive and gain nothing.
constexpr std::size_t kMostTightCells = 1000;

// The part of delta that is left between the radii wanted and the bound to be proven. Smaller: fewer rounds;
// more work where the solid is equally thick everywhere.
constexpr double kUndecided = 0.25;

// Side of a block, in wanted radii, at least. Larger blocks: fewer look-ups of spheres, longer lists of them.
constexpr double kBlockSide = 4;

using Active = GreedyRounds::Active;

int blockLevel(double wanted) {
  return std::clamp(static_cast<int>(std::floor(-steady::log2(kBlockSide * wanted))), 0, 20);
}

// Active cells in the order of blocks, and where each block begins.
std::vector<std::size_t> sortIntoBlocks(std::vector<Active>& active, int level) {
  tbb::parallel_for(std::size_t{0}, active.size(), [&](std::size_t i) {
    active[i].block = mortonCode(active[i].cell, level) << 1 | (active[i].cell.level < level);
  });
  tbb::parallel_sort(active.begin(), active.end(), [](const Active& a, const Active& b) {
    const auto key = [](const Active& c) {
      return std::make_tuple(c.block, c.cell.level, c.cell.at[2], c.cell.at[1], c.cell.at[0]);
    };
    return key(a) < key(b);
  });
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < active.size(); ++i) {
    const bool large = active[i].cell.level < level;  // larger than a block: alone
    if (i == 0 || large || active[i].block != active[i - 1].block) begins.push_back(i);
  }
  begins.push_back(active.size());
  return begins;
}

/// Larger candidates come first, equal ones in the order of the Z-order curve.
void sortCandidates(std::vector<CellSearch::Candidate>& candidates) {
  std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    // In single precision: what differs by rounding only is equal.
    const auto r = static_cast<float>(a.ball.radius), s = static_cast<float>(b.ball.radius);
    return r != s ? r > s : a.order < b.order;
  });
}

}  // namespace

/// What a round is certain of, wants and has to prove; see CellSearch.
struct GreedyRounds::Round {
  float top, bound;
  double wanted;
};

std::vector<CellSearch::Result> GreedyRounds::search(std::vector<Active>& active, const Round& round,
                                                     const SphereGrid& grid) const {
  const std::vector<std::size_t> begins = sortIntoBlocks(active, blockLevel(round.wanted));
  std::vector<CellSearch::Result> results(begins.size() - 1);
  tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t block) {
    std::vector<Cell> cells;
    for (std::size_t i = begins[block]; i < begins[block + 1]; ++i) cells.push_back(active[i].cell);
    results[block] = CellSearch(container_, grid, round.top, round.bound, round.wanted).search(cells);
  });
  return results;
}

bool GreedyRounds::insert(const std::vector<CellSearch::Candidate>& candidates, float top, const Stop& stop,
                          const Add& add, Placed& placed) const {
  for (const CellSearch::Candidate& candidate : candidates) {
    const Ball& ball = candidate.ball;
    if (placed.grid.nearest(ball.centre, ball.radius).distance < ball.radius) {
      assert(&candidate != &candidates.front());  // or the same turn would come again and again
      continue;
    }
    placed.grid.insert(ball);
    placed.rounded.push_back(container_.rounded(ball));
    placed.top.push_back(top);
    if (stop(placed) || (add && add(placed, top))) return true;
  }
  return false;
}

GreedyRounds::Placed GreedyRounds::run(tbb::task_arena& arena, const Stop& stop, const Pause& pause,
                                       const Add& add) const {
  // The steps of the radius schedule are the bounds of rounds with the tight delta; a round with a larger
  // delta takes several at once.
  const double tight = std::min(kTightDelta, delta_);
  const auto strides = static_cast<std::size_t>(steady::log1p(delta_) / steady::log1p(tight) + 1e-9);
  if (min_radius_ >= 0.5) return {};
  const RadiusSchedule schedule(1, min_radius_ * steady::pow(1 + tight, kUndecided),
                                steady::pow(1 + tight, 1 - kUndecided));
  CellQueue queue(schedule);
  queue.push(Cell{});
  Placed placed;

  while (!queue.empty()) {
    const std::size_t step = queue.top();
    const bool early = placed.top.size() < kTightSpheres && queue.countAbove(step + 1) < kMostTightCells;
    const std::size_t next = step + (early ? 1 : strides);
    const float top = schedule[step], bound = schedule[next];
    const Round round{top, bound, std::max(top / (1 + (early ? tight : delta_) * (1 - 1e-5)), min_radius_)};
    placed.largest_missing = top;
    std::vector<Active> active;
    for (const Cell& cell : queue.takeAbove(next)) active.push_back({0, cell});
    while (!active.empty()) {
      if (pause(placed, bound)) return placed;
      std::vector<CellSearch::Result> results;
      arena.execute([&] { results = search(active, round, placed.grid); });
      active.clear();
      std::vector<CellSearch::Candidate> candidates;
      for (const CellSearch::Result& result : results) {
        for (const Cell& cell : result.cells) {
          if (cell.upper > bound) {
            active.push_back({0, cell});
          } else {
            queue.push(cell);
          }
        }
        candidates.insert(candidates.end(), result.candidates.begin(), result.candidates.end());
      }
      sortCandidates(candidates);
      if (insert(candidates, top, stop, add, placed)) return placed;
    }
    placed.largest_missing = bound;
  }
  placed.largest_missing = schedule[schedule.size() - 1];
  return placed;
}

}  // namespace innersphere
