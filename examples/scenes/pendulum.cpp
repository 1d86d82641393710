#include "pendulum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "recording.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

double angleOf(const BodyState& state, const Vec3d& pivot) {
  return std::atan2(state.position[0] - pivot[0], pivot[2] - state.position[2]);
}

// The mean over all swings, from one passage through the lowest place to the others; 0 if there are too few.
double measuredPeriod(const Recording& r, std::size_t body, const Vec3d& pivot) {
  std::vector<double> passages;
  double before = angleOf(r.first(body), pivot);
  for (std::size_t s = 1; s < r.steps.size(); ++s) {
    const double now = angleOf(r.body(body, s), pivot);
    const double from = r.steps[s - 1].time, to = r.steps[s].time;
    if ((before < 0) != (now < 0)) passages.push_back(from + (to - from) * before / (before - now));
    before = now;
  }
  if (passages.size() < 3) return 0;
  return 2 * (passages.back() - passages.front()) / static_cast<double>(passages.size() - 1);
}

}  // namespace

double Pendulum::period() const {
  double a = 1, b = std::cos(amplitude / 2);
  while (a - b > 1e-12) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2 * std::numbers::pi * std::sqrt(length / kGravity) / a;
}

void expectPendulum(SceneWorld& world, std::size_t body, const Pendulum& pendulum) {
  const double period = pendulum.period();
  const double end = (pendulum.swings + 0.25) * period;
  Truth& truth =
      world.expect({"period", "s", Truth::Kind::equal, period, 0.01 * period,
                    "2 pi sqrt((R - r) / g) / agm(1, cos(amplitude / 2)): the centre slides on a circle; 1 %",
                    [=](const Recording& r) { return measuredPeriod(r, body, pendulum.pivot); }, end});
  truth.known_miss = pendulum.known_miss;
  world.expect({"amplitude left after " + std::to_string(pendulum.swings) + " swings", "", Truth::Kind::equal,
                1, 0.1, "nothing rubs: all of it; 10 %",
                [=](const Recording& r) {
                  double largest = 0;
                  for (std::size_t s = r.stepAt(end - 0.5 * period); s <= r.stepAt(end); ++s)
                    largest = std::max(largest, std::abs(angleOf(r.body(body, s), pendulum.pivot)));
                  return largest / pendulum.amplitude;
                },
                end});
}

}  // namespace innersphere::demo
