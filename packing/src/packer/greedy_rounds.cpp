#include "packer/greedy_rounds.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <tuple>

#include "common/hash.hpp"
#include "common/steady_math.hpp"
#include "innersphere/error.hpp"

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

// Where one of this many parts of a round has as many candidates as it would take for all spheres, the others
// are left for later. Fewer: more is searched in vain; more: one part tells less. Parts of many blocks have
// parts of their own.
constexpr std::uint64_t kParts = 16;

// Rounds with no more blocks than this are searched whole.
constexpr std::size_t kMostWholeBlocks = 64 * kParts;

// The solid is equally thick everywhere where a round looks at more than so many cells for each sphere
// placed, and for a thousand more.
constexpr std::size_t kManyCells = 15, kFewSpheres = 1000;

// Side of a block, in wanted radii, at least. Larger blocks: fewer look-ups of spheres, longer lists of them.
constexpr double kBlockSide = 4;

using Active = GreedyRounds::Active;

int blockLevel(double wanted) {
  return std::clamp(static_cast<int>(std::floor(-steady::log2(kBlockSide * wanted))), 0, 20);
}

/// Returns the place of the cell's block along the Z-order curve. A cell larger than a block is one by
/// itself.
std::uint64_t blockOf(const Cell& cell, int level) {
  return mortonCode(cell, level) << 1 | (cell.level < level);
}

/// Brings the cells into the order of blocks of this level. Their children stay in it.
std::vector<Active> sortIntoBlocks(const std::vector<Cell>& cells, int level) {
  std::vector<Active> active(cells.size());
  tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t i) {
    active[i] = {blockOf(cells[i], level), cells[i]};
  });
  tbb::parallel_sort(active.begin(), active.end(),
                     [](const Active& a, const Active& b) { return a.block < b.block; });
  return active;
}

/// Returns where each block begins, and the end.
std::vector<std::size_t> beginsOf(const std::vector<Active>& active) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (i == 0 || active[i].block != active[i - 1].block) begins.push_back(i);
  }
  begins.push_back(active.size());
  return begins;
}

/// Sorts the cells of one block, so that nothing depends on the order in which they were found.
void sortCells(std::vector<Cell>& cells) {
  const auto key = [](const Cell& c) { return std::make_tuple(c.level, c.at[2], c.at[1], c.at[0]); };
  std::sort(cells.begin(), cells.end(), [&](const Cell& a, const Cell& b) { return key(a) < key(b); });
}

/// Returns 1 for one of kParts blocks, spread at random, other ones in each turn, 2 for one of kParts of
/// these, and so on up to `most`; else 0.
int partOf(std::uint64_t block, std::uint64_t turn, int most) {
  std::uint64_t random = mixed(block * kParts + turn % kParts);
  int part = 0;
  for (; part < most && random % kParts == 0; random /= kParts) ++part;
  return part;
}

[[noreturn]] void throwTooThin(const Container& container) {
  throw Error(
      ErrorCode::bad_argument,
      "'" + container.solid().name() +
          "' is so thin beside its size that its spheres have too many places to look at; make it thicker or "
          "smaller, or ask for a larger min_radius");
}

/// Larger candidates come first, equal ones in the order of the Z-order curve; those of a part at random, as
/// there may be more than are wanted.
void sortCandidates(std::vector<CellSearch::Candidate>& candidates, bool whole) {
  const auto order = [&](const CellSearch::Candidate& c) { return whole ? c.order : mixed(c.order); };
  std::sort(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
    // In single precision: what differs by rounding only is equal.
    const auto r = static_cast<float>(a.ball.radius), s = static_cast<float>(b.ball.radius);
    return r != s ? r > s : order(a) < order(b);
  });
}

}  // namespace

/// What a round is certain of, wants and has to prove; see CellSearch.
struct GreedyRounds::Round {
  float top, bound;
  double wanted;
  bool equally_thick;
  int level;               ///< of the blocks
  std::size_t most_cells;  ///< live after a search
};

/// The cells that are live after a search, searched or not, in the order of blocks, and the candidates.
struct GreedyRounds::Found {
  std::vector<Active> active;
  std::vector<CellSearch::Candidate> candidates;
};

GreedyRounds::Found GreedyRounds::search(const std::vector<Active>& active, const Round& round,
                                         std::uint64_t turn, const SphereGrid& grid) const {
  const std::vector<std::size_t> begins = beginsOf(active);
  const std::size_t blocks = begins.size() - 1;
  std::vector<CellSearch::Result> results(blocks);
  int part = 0;
  for (std::size_t rest = blocks; rest > kMostWholeBlocks; rest /= kParts) ++part;
  std::vector<int> parts(blocks);
  for (std::size_t b = 0; b < blocks; ++b) parts[b] = partOf(active[begins[b]].block, turn, part);
  std::size_t count = 0;
  std::atomic<std::size_t> live = active.size();
  const auto searchPart = [&] {
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
      if (parts[b] != part) return;
      std::vector<Cell> cells;
      for (std::size_t i = begins[b]; i < begins[b + 1]; ++i) cells.push_back(active[i].cell);
      sortCells(cells);
      results[b] = CellSearch(container_, grid, round.top, round.bound, round.wanted, round.equally_thick)
                       .search(cells);
      if ((live += results[b].cells.size()) > round.most_cells) throwTooThin(container_);
    });
    for (std::size_t b = 0; b < blocks; ++b) count += parts[b] == part ? results[b].candidates.size() : 0;
  };
  // A part of a part has to have as many candidates as may be wanted: it tells less than the part.
  for (; part > 0; --part) {
    searchPart();
    if (count > (part > 1 ? most_ : most_ / kParts)) break;
  }
  const bool whole = part == 0;
  if (whole) searchPart();

  Found found;
  for (std::size_t b = 0; b < blocks; ++b) {
    if (parts[b] >= part) {
      const CellSearch::Result& result = results[b];
      const Active& block = active[begins[b]];
      const bool large = block.cell.level < round.level;
      for (const Cell& cell : result.cells)
        found.active.push_back({large ? blockOf(cell, round.level) : block.block, cell});
      found.candidates.insert(found.candidates.end(), result.candidates.begin(), result.candidates.end());
    } else {
      for (std::size_t i = begins[b]; i < begins[b + 1]; ++i) found.active.push_back(active[i]);
    }
  }
  sortCandidates(found.candidates, whole);
  return found;
}

bool GreedyRounds::insert(const std::vector<CellSearch::Candidate>& candidates, float top, const Stop& stop,
                          const Add& add, Placed& placed) const {
  for (const CellSearch::Candidate& candidate : candidates) {
    container_.goOn();
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
    placed.largest_missing = top;
    const std::vector<Cell> cells = queue.takeAbove(next);
    const bool equally_thick = cells.size() > kManyCells * (placed.top.size() + kFewSpheres);
    const double wanted = std::max(top / (1 + (early ? tight : delta_) * (1 - 1e-5)), min_radius_);
    const std::size_t most_cells = most_cells_ + kMostCellsPerSphere * placed.top.size();
    if (queue.live() > most_cells) throwTooThin(container_);
    const Round round{top, bound, wanted, equally_thick, blockLevel(wanted), most_cells - queue.live()};
    std::vector<Active> active;
    arena.execute([&] { active = sortIntoBlocks(cells, round.level); });
    for (std::uint64_t turn = 0; !active.empty(); ++turn) {
      if (pause(placed, bound)) return placed;
      Found found;
      arena.execute([&] { found = search(active, round, turn, placed.grid); });
      active.clear();
      for (const Active& live : found.active) {
        if (live.cell.upper > bound) {
          active.push_back(live);
        } else {
          queue.push(live.cell);
        }
      }
      if (insert(found.candidates, top, stop, add, placed)) return placed;
    }
    placed.largest_missing = bound;
  }
  placed.largest_missing = schedule[schedule.size() - 1];
  return placed;
}

}  // namespace innersphere
