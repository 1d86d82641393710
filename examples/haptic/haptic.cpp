// A force loop at 1 kHz, as a haptic device wants it, without a physics world: a hand leads one solid into
// another and out again, and in every millisecond the overlap gives the force and torque on it.
//   innersphere pack gear --spheres 4000 -o gear.cbor && haptic gear.cbor gear.cbor
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "innersphere/error.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/query.hpp"

namespace {

using namespace innersphere;
using Clock = std::chrono::steady_clock;

/// Half the width of the packing along x, and the middle of it.
struct Extent {
  double middle, half;
};

Extent extentOf(const Packing& packing) {
  double lo = packing.spheres[0].x, hi = lo;
  for (const Sphere& s : packing.spheres) {
    lo = std::min(lo, double{s.x} - s.radius);
    hi = std::max(hi, double{s.x} + s.radius);
  }
  return {(lo + hi) / 2, (hi - lo) / 2};
}

/// Where the hand is: it turns the solid about z and moves it along x, from not touching to half its width
/// deep.
Placement handAt(double seconds, const Extent& still, const Extent& moved) {
  const double angle = 0.5 * seconds, c = std::cos(angle), s = std::sin(angle);
  const double depth = moved.half * (0.45 - 0.55 * std::cos(2 * seconds));
  Placement placement;
  placement.rotation = {c, -s, 0, s, c, 0, 0, 0, 1};
  placement.translation = {still.middle + still.half + moved.half - depth - c * moved.middle,
                           -s * moved.middle, 0};
  return placement;
}

void print(const char* what, std::vector<double>& microseconds) {
  std::sort(microseconds.begin(), microseconds.end());
  const auto share = [&](double of) {
    return microseconds[static_cast<std::size_t>(of * static_cast<double>(microseconds.size() - 1))];
  };
  std::printf("%-24s p50 %7.1f   p99 %7.1f   p99.9 %7.1f   worst %7.1f us\n", what, share(0.5), share(0.99),
              share(0.999), microseconds.back());
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Overlap forces in a loop at 1 kHz; prints how long the queries take");
  std::string still_file, moved_file;
  double seconds = 10;
  std::string backend = "cpu";
  std::uint32_t prefix = 0;
  app.add_option("STILL", still_file, "Packing of the solid that stays")->required();
  app.add_option("MOVED", moved_file, "Packing of the solid that the hand leads")->required();
  app.add_option("--seconds", seconds, "Length of the run")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e4));
  app.add_option("--backend", backend)->capture_default_str()->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  app.add_option("--spheres", prefix, "Use only the largest so many of each; 0: all")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const auto still_packing = std::make_shared<const Packing>(readPacking(still_file));
  const auto moved_packing = std::make_shared<const Packing>(readPacking(moved_file));
  const CollisionModel still(still_packing), moved(moved_packing);
  const Extent still_extent = extentOf(*still_packing), moved_extent = extentOf(*moved_packing);
  const Backend where = backend == "cuda"  ? Backend::cuda
                        : backend == "cpu" ? Backend::cpu
                                           : Backend::automatic;
  QueryContext context({where, 1});  // one thread: waking others up would cost more than it gives
  PairQuery query;
  query.a = &still;
  query.b = &moved;
  query.prefix_a = query.prefix_b = prefix;

  constexpr std::chrono::microseconds kTick(1000);
  const auto ticks = static_cast<std::size_t>(seconds * 1000);
  std::vector<double> queries, wakes;
  queries.reserve(ticks);
  wakes.reserve(ticks);
  std::size_t late = 0;
  double strongest = 0;
  query.placement_b = handAt(1.5, still_extent, moved_extent);
  for (int i = 0; i < 10; ++i) context.overlap(query);  // builds the grids and warms up

  const Clock::time_point start = Clock::now();
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const Clock::time_point due = start + tick * kTick;
    std::this_thread::sleep_until(due);
    const Clock::time_point begin = Clock::now();
    query.placement_b = handAt(1e-3 * static_cast<double>(tick), still_extent, moved_extent);
    const Overlap overlap = context.overlap(query);  // times a stiffness, this goes to the device
    const Clock::time_point end = Clock::now();
    const Vec3d& f = overlap.force;
    strongest = std::max(strongest, std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]));
    queries.push_back(std::chrono::duration<double, std::micro>(end - begin).count());
    wakes.push_back(std::chrono::duration<double, std::micro>(begin - due).count());
    late += end > due + kTick;
  }
  print("query", queries);
  print("woken after the tick by", wakes);
  std::printf(
      "%zu of %zu forces came after their millisecond; the strongest was %.4g m^3 for unit stiffness\n", late,
      ticks, strongest);
  return 0;
} catch (const innersphere::Error& error) {
  std::fprintf(stderr, "%s: %s\n", toString(error.code()), error.what());
  return 3;
}
