#include "packer/rounds.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace innersphere {
namespace {

// The first spheres decide most of the density and cost little: they are placed with a tight delta.
constexpr std::size_t kTightSpheres = 300;
constexpr double kTightDelta = 0.01;

// Side of a brick, in thresholds, at least. Larger bricks: fewer look-ups of spheres, longer lists of them.
constexpr double kBrick = 8;

struct Active {
  std::uint64_t brick;
  Cell cell;
};

int brickLevel(float threshold) {
  return std::clamp(static_cast<int>(std::floor(-std::log2(kBrick * threshold))), 0, 20);
}

// Active cells in the order of bricks, and where each brick begins.
std::vector<std::size_t> sortIntoBricks(std::vector<Active>& active, int level) {
  tbb::parallel_for(std::size_t{0}, active.size(), [&](std::size_t i) {
    active[i].brick = mortonCode(active[i].cell, level) << 1 | (active[i].cell.level < level);
  });
  tbb::parallel_sort(active.begin(), active.end(), [](const Active& a, const Active& b) {
    const auto key = [](const Active& c) {
      return std::make_tuple(c.brick, c.cell.level, c.cell.at[2], c.cell.at[1], c.cell.at[0]);
    };
    return key(a) < key(b);
  });
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < active.size(); ++i) {
    const bool large = active[i].cell.level < level;  // larger than a brick: alone
    if (i == 0 || large || active[i].brick != active[i - 1].brick) begins.push_back(i);
  }
  begins.push_back(active.size());
  return begins;
}

}  // namespace

Rounds::Placed Rounds::run(tbb::task_arena& arena, const std::function<bool(const Placed&)>& stop,
                           const std::function<bool(const Placed&, float)>& pause) {
  const double delta = delta_ * (1 - 1e-4);
  const auto tight_steps = static_cast<std::size_t>(std::ceil(std::log1p(delta) / std::log1p(kTightDelta)));
  const Ladder ladder(0.5, min_radius_, std::exp(std::log1p(delta) / static_cast<double>(tight_steps)));
  CellQueue queue(ladder);
  queue.push(Cell{{0, 0, 0}, 0.5f, 0});
  Placed placed;
  SphereGrid& grid = placed.grid;

  while (!queue.empty()) {
    const std::size_t rung = queue.top();
    const std::size_t next = rung + (grid.balls().size() < kTightSpheres ? 1 : tight_steps);
    const float top = ladder[rung], threshold = ladder[next];
    placed.largest_missing = top;
    std::vector<Active> active;
    for (const Cell& cell : queue.takeAbove(next)) active.push_back({0, cell});
    while (!active.empty()) {
      if (pause(placed, threshold)) return placed;
      std::vector<CellSearch::Result> results;
      arena.execute([&] {
        const std::vector<std::size_t> begins = sortIntoBricks(active, brickLevel(threshold));
        results.resize(begins.size() - 1);
        tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t brick) {
          std::vector<Cell> cells;
          for (std::size_t i = begins[brick]; i < begins[brick + 1]; ++i) cells.push_back(active[i].cell);
          results[brick] = CellSearch(container_, grid, top, threshold).search(cells);
        });
      });
      active.clear();
      std::vector<CellSearch::Candidate> candidates;
      for (const CellSearch::Result& result : results) {
        for (const Cell& cell : result.cells) {
          if (cell.upper > threshold) {
            active.push_back({0, cell});
          } else {
            queue.push(cell);
          }
        }
        candidates.insert(candidates.end(), result.candidates.begin(), result.candidates.end());
      }
      std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
        return a.ball.radius != b.ball.radius ? a.ball.radius > b.ball.radius : a.order < b.order;
      });
      for (const CellSearch::Candidate& candidate : candidates) {
        const Ball& ball = candidate.ball;
        if (grid.nearest(ball.centre, ball.radius).distance < ball.radius) continue;
        grid.insert(ball);
        placed.top.push_back(top);
        if (stop(placed)) return placed;
      }
    }
    placed.largest_missing = threshold;
  }
  placed.largest_missing = ladder[ladder.size() - 1];
  return placed;
}

}  // namespace innersphere
