// A force loop at 1 kHz, as a haptic device wants it, without a physics world: a hand leads one solid into
// another and out again, and in every millisecond the overlap gives the force and torque on it. Each query
// uses as many spheres as its budget of time allows.
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

#include "innersphere/bounded_query.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packing_file.hpp"

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

void print(const char* what, std::vector<double>& values, const char* unit) {
  std::sort(values.begin(), values.end());
  const auto share = [&](double of) {
    return values[static_cast<std::size_t>(of * static_cast<double>(values.size() - 1))];
  };
  std::printf("%-24s p50 %7.1f   p99 %7.1f   p99.9 %7.1f   worst %7.1f %s\n", what, share(0.5), share(0.99),
              share(0.999), values.back(), unit);
}

struct Arguments {
  std::string still, moved;
  double seconds = 10, budget = 500;
  std::string backend = "cpu";
  std::uint32_t spheres = 0;
};

Backend backendOf(const std::string& name) {
  return name == "cuda" ? Backend::cuda : name == "cpu" ? Backend::cpu : Backend::automatic;
}

void run(const Arguments& arguments) {
  const auto still_packing = std::make_shared<const Packing>(readPacking(arguments.still));
  const auto moved_packing = std::make_shared<const Packing>(readPacking(arguments.moved));
  const CollisionModel still(still_packing), moved(moved_packing);
  const Extent still_extent = extentOf(*still_packing), moved_extent = extentOf(*moved_packing);
  QueryContext context({backendOf(arguments.backend), 1});  // one thread: waking others would cost more
  BoundedQuery bounded(context);
  const QueryBudget budget{1e-6 * arguments.budget, 0};
  PairQuery query{&still, &moved, {}, {}, arguments.spheres, arguments.spheres, 0};

  constexpr std::chrono::microseconds kTick(1000);
  const auto ticks = static_cast<std::size_t>(arguments.seconds * 1000);
  std::vector<double> queries, wakes;
  queries.reserve(ticks);
  wakes.reserve(ticks);
  std::size_t late = 0, over = 0, touching = 0;
  double strongest = 0, errors = 0, used = 0;
  query.placement_b = handAt(1.5, still_extent, moved_extent);
  bounded.warmUp(query);  // at the deepest place of the path: it is the slowest

  const Clock::time_point start = Clock::now();
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const Clock::time_point due = start + tick * kTick;
    std::this_thread::sleep_until(due);
    const Clock::time_point begin = Clock::now();
    query.placement_b = handAt(1e-3 * static_cast<double>(tick), still_extent, moved_extent);
    const BoundedOverlap result = bounded.overlap(query, budget);  // times a stiffness, to the device
    const Clock::time_point end = Clock::now();
    const Vec3d& f = result.overlap.force;
    strongest = std::max(strongest, std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]));
    queries.push_back(std::chrono::duration<double, std::micro>(end - begin).count());
    wakes.push_back(std::chrono::duration<double, std::micro>(begin - due).count());
    late += end > due + kTick;
    over += arguments.budget > 0 && queries.back() > arguments.budget;
    used += result.prefix_b;
    if (!std::isnan(result.error)) {
      errors += result.error;
      ++touching;
    }
  }
  print("query", queries, "us");
  print("woken after the tick by", wakes, "us");
  std::printf("%zu of %zu forces came after their millisecond; %zu queries were over their budget\n", late,
              ticks, over);
  std::printf("%.0f spheres of each on average", used / static_cast<double>(ticks));
  if (touching > 0)
    std::printf("; volumes are %.1f %% off, by what the packings state",
                100 * errors / static_cast<double>(touching));
  std::printf("\nthe strongest force was %.4g m^3 for unit stiffness\n", strongest);
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app(
      "Overlap forces in a loop at 1 kHz, each with as many spheres as its budget of time allows; prints how "
      "long the "
      "queries take and how many deadlines they miss.");
  Arguments arguments;
  app.add_option("STILL", arguments.still, "Packing of the solid that stays")->required();
  app.add_option("MOVED", arguments.moved, "Packing of the solid that the hand leads")->required();
  app.add_option("--seconds", arguments.seconds, "Length of the run")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e4));
  app.add_option("--budget", arguments.budget, "Microseconds for a query; 0: as long as all spheres take")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--backend", arguments.backend)
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  app.add_option("--spheres", arguments.spheres, "Use at most the largest so many of each; 0: all")
      ->capture_default_str();
  app.footer(
      "Example:\n"
      "  innersphere pack gear --spheres 16384 -o gear.cbor\n"
      "  haptic gear.cbor gear.cbor --budget 300");
  CLI11_PARSE(app, argc, argv);
  run(arguments);
  return 0;
} catch (const innersphere::Error& error) {
  std::fprintf(stderr, "%s: %s\n", toString(error.code()), error.what());
  return 3;
}
