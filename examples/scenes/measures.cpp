#include "measures.hpp"

#include <algorithm>
#include <cmath>

#include "recording.hpp"

namespace innersphere::demo {

Measure finalCoordinate(std::size_t body, int axis) {
  return [=](const Recording& r) { return r.last(body).position[static_cast<std::size_t>(axis)]; };
}

Measure farthestOfAll(std::size_t first_body, std::size_t count, double from) {
  return [=](const Recording& r) {
    double farthest = 0;
    for (std::size_t i = 0; i < count; ++i) {
      farthest = std::max(farthest, r.farthestFrom(first_body + i, from));
    }
    return farthest;
  };
}

Measure largestTurn(std::size_t first_body, std::size_t count, double from) {
  return [=](const Recording& r) {
    double largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
      largest = std::max(largest, r.turnBetween(first_body + i, from, r.seconds()));
    }
    return largest;
  };
}

std::vector<double> motionsAtTheEnd(const Recording& r, const std::vector<double>& sizes) {
  const double from = std::max(0.0, r.seconds() - kRestTime);
  std::vector<double> motions(sizes.size(), 0.0);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (sizes[i] == 0) continue;
    const Vec3d &a = r.body(i, r.stepAt(from)).position, &b = r.last(i).position;
    const double way = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    motions[i] = way / sizes[i] + r.turnBetween(i, from, r.seconds()) / 2;
  }
  return motions;
}

double turnedAboutZ(const Recording& r, std::size_t body, double from, double to) {
  double angle = 0;
  for (std::size_t s = r.stepAt(from) + 1; s <= r.stepAt(to); ++s) {
    // By z and w of (rotation now) (rotation before)^-1.
    const auto &p = r.body(body, s - 1).rotation, &q = r.body(body, s).rotation;
    const double z = q[2] * p[3] - q[3] * p[2] - q[0] * p[1] + q[1] * p[0];
    const double w = q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3];
    angle += 2 * std::atan2(w < 0 ? -z : z, std::abs(w));
  }
  return angle;
}

Truth energyGainBelow(double limit, double reference, const std::string& what_reference) {
  return {"energy from nowhere",
          "",
          Truth::Kind::at_most,
          limit,
          0,
          "increments of the total energy over " + what_reference + "; the limit is what GImpact gains here",
          [reference](const Recording& r) { return r.energyGained() / reference; }};
}

}  // namespace innersphere::demo
