// Overlap queries beside the triangle-mesh collision of other libraries, on the same poses, one core.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "exact_poses.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/patch.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"
#include "peer.hpp"
#include "source.hpp"
#include "sweep.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

/// One column of the table: what is done at a pose, and what it counts.
struct Work {
  std::string name;
  std::function<std::size_t(const Placement&)> run;
};

/// Ours, for one packing and a copy of it.
class Ours {
 public:
  explicit Ours(std::shared_ptr<const Packing> packing)
      : model_(std::move(packing)), context_({Backend::cpu, 1}) {}

  std::size_t wrench(const Placement& copy) {
    return context_.overlap(query(copy), {Want::wrench, Estimator::volume_true}).pair_count;
  }

  /// Volume, wrench and patches.
  std::size_t patches(const Placement& copy) {
    const PairQuery pair = query(copy);
    context_.run(&pair, 1, {Want::contacts_of_a, Estimator::volume_true}, result_);
    buildPatches(result_.contacts_a.items.data(), result_.contacts_a.items.size(), {}, patches_);
    return patches_.size();
  }

 private:
  PairQuery query(const Placement& copy) const {
    return {&model_, &model_, placed(model_.packing(), {}), placed(model_.packing(), copy), 0, 0, 0};
  }

  CollisionModel model_;
  QueryContext context_;
  QueryResult result_;
  std::vector<Patch> patches_;
};

std::vector<Placement> posesOf(const std::string& table, const Bounds& box, std::size_t count) {
  if (table.empty()) return sweepPoses(box, {0, 0, 1}, count);
  std::vector<Placement> poses;
  for (const ExactPose& pose : readOverlappingPoses(table)) poses.push_back(pose.placement);
  return poses;
}

void compare(const std::string& item, std::size_t spheres, std::size_t passes) {
  const std::size_t equals = item.find('=');
  const std::string source = item.substr(0, equals);
  const std::unique_ptr<Solid> solid = solidFrom(source);
  const std::vector<Placement> poses =
      posesOf(equals == std::string::npos ? "" : item.substr(equals + 1), solid->bounds(), 72);
  const Mesh mesh = solid->surface();
  PackOptions options;
  options.spheres = spheres;
  Ours ours(std::make_shared<const Packing>(pack(*solid, options)));

  std::vector<Work> works;
  const auto peers = makePeers(mesh);
  for (const auto& peer : peers)
    works.push_back({peer->name(), [&peer](const Placement& copy) { return peer->contacts(copy); }});
  works.push_back({"wrench", [&](const Placement& copy) { return ours.wrench(copy); }});
  works.push_back({"patches", [&](const Placement& copy) { return ours.patches(copy); }});

  // All kinds of work at a pose, then the next pose.
  std::vector<double> counts(works.size() * poses.size());
  const std::vector<double> times = leastTimes(counts.size(), passes, [&](std::size_t i) {
    counts[i] = static_cast<double>(works[i % works.size()].run(poses[i / works.size()]));
  });
  std::vector<double> medians, worst, found;
  for (std::size_t w = 0; w < works.size(); ++w) {
    std::vector<double> own, own_counts;
    for (std::size_t i = w; i < times.size(); i += works.size()) {
      own.push_back(times[i]);
      own_counts.push_back(counts[i]);
    }
    medians.push_back(median(own));
    worst.push_back(quantile(own, 1));
    found.push_back(median(own_counts));
  }
  const double fastest =
      *std::min_element(medians.begin(), medians.begin() + static_cast<std::ptrdiff_t>(peers.size()));
  std::printf("| %s | %zu | %zu |", plainName(source).c_str(), mesh.triangles.size(), poses.size());
  for (std::size_t w = 0; w < works.size(); ++w) {
    std::printf(" %.0f (%.0f) |", medians[w], worst[w]);
    if (w == 0 && peers.size() == 1) std::printf(" - |");
  }
  std::printf(" %.1f | %.1f |\n", fastest / medians[works.size() - 2], fastest / medians.back());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Overlap queries beside triangle-mesh collision by Bullet's GImpact and FCL, with all contacts, on the "
      "same "
      "poses and on one core. A Markdown table on stdout.");
  std::vector<std::string> sources{"torus", "gear", "nut"};
  std::size_t spheres = 4000, passes = 7;
  app.add_option(
      "SOLID[=POSES]", sources,
      "Mesh files or names of solids, each with a CSV table of poses of its copy or else in a sweep of 72 "
      "poses");
  app.add_option("--spheres", spheres)->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--passes", passes, "Each time is the least of so many runs")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", heading("Overlap queries beside triangle meshes", argc, argv).c_str());
    std::printf(
        "%zu spheres, volume-true radii; median (worst) over the poses, us.\n\n"
        "| solid | triangles | poses | GImpact | FCL | volume and wrench | and patches | wrench: times "
        "faster than the faster peer | patches: times faster |\n|---|---|---|---|---|---|---|---|---|\n",
        spheres);
    for (const std::string& source : sources) compare(source, spheres, passes);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
