// The part of CellSearch that finds the way up to a local maximum.
#include <algorithm>
#include <cmath>

#include "packer/cell_search.hpp"

namespace innersphere {

bool CellSearch::climb(Point x) {
  const Point start = x;
  Probe best = probe(x, 0, block_balls_, 0, 0);
  double half = 0.5 * best.value;
  DualSimplex& program = climb_program_;
  while (half > 1e-4 * best.value) {
    // The linear programme is trusted within a cube. As long as that keeps to the ball about x, all of it
    // lies inside the solid.
    half = std::min({half, 0.55 * best.value, (kWander * wanted_ - (x - start).norm()) / 1.75});
    const double before = best.value;
    const Point centre = x;
    program.restart(half);
    program.add(best.value, best.gradient);
    for (std::size_t i = 0; i < block_balls_; ++i) {
      const double distance = balls_[i].distance(centre);
      if (distance < best.value + 3.5 * half) program.add(distance, direction(balls_[i].centre, centre));
    }
    for (int step = 0; step < 10 && program.optimum() > best.value * (1 + 1e-5); ++step) {
      const Point y = centre + program.argmax();
      const Probe p = probe(y, 0, block_balls_, best.value, 0);
      if (p.value > best.value) {
        best = p;
        x = y;
      }
      if (program.optimum() - p.value < 1e-5 * best.value) break;
      program.add(p.value - p.gradient.dot(y - centre), p.gradient);
    }
    const bool at_wall = (x - centre).cwiseAbs().maxCoeff() > 0.9 * half;
    if (best.value < before * (1 + 1e-4)) {
      half /= 8;
    } else if (!at_wall) {
      half /= 2;
    }
  }
  if (best.value <= wanted_) return false;
  const Ball ball{x, best.value};
  for (const Candidate& other : result_.candidates) {
    if (other.ball.distance(ball.centre) < ball.radius) return true;
  }
  Cell place{{}, 0, 20};
  for (int k = 0; k < 3; ++k) place.at[k] = static_cast<std::uint32_t>(ball.centre[k] / place.side());
  result_.candidates.push_back({ball, mortonCode(place, place.level)});
  return true;
}

}  // namespace innersphere
