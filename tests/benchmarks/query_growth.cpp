// Two interlocked Chazelle polyhedra of growing complexity: triangle meshes against spheres.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"
#include "peer.hpp"
#include "points_file.hpp"
#include "solids/named_meshes.hpp"
#include "timing.hpp"
#include "true_overlap.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

constexpr std::size_t kPasses = 5;
constexpr std::size_t kSamples = 1 << 20;
constexpr const char* kColumns = " spheres | pairs | time | error raw, % | volume-true, % |";

/// The wedges of the copy's bottom cross those of the first one's top, each with each. The shift along x and
/// y keeps the outer walls from being in one plane.
Placement interlocked() {
  Placement copy;
  copy.translation = {0.013, 0.007, 0.7};
  return copy;
}

class Spheres {
 public:
  Spheres(const Solid& solid, std::size_t spheres)
      : model_(packed(solid, spheres)), context_({Backend::cpu, 1}) {}

  std::size_t count() const { return model_.packing().spheres.size(); }
  Overlap query(Estimator estimator) {
    return context_.overlap({&model_, &model_, {}, interlocked(), 0, 0, 0}, {Want::wrench, estimator});
  }

 private:
  static std::shared_ptr<const Packing> packed(const Solid& solid, std::size_t spheres) {
    PackOptions options;
    options.spheres = spheres;
    return std::make_shared<const Packing>(pack(solid, options));
  }

  CollisionModel model_;
  QueryContext context_;
};

void row(int wedges, std::size_t fixed, double per_triangle, FILE* points) {
  const Mesh mesh = wedgedCube(wedges);
  const std::size_t triangles = mesh.triangles.size();
  const std::unique_ptr<Solid> solid = makeSolid(mesh, "chazelle");
  const SampledVolume truth = sampledOverlap(*solid, interlocked(), kSamples);
  const auto peers = makePeers(mesh);
  Spheres few(*solid, fixed),
      many(*solid, static_cast<std::size_t>(per_triangle * static_cast<double>(triangles)));

  std::size_t contacts = 0;
  std::vector<std::function<void()>> works;
  for (const auto& peer : peers) works.push_back([&] { contacts = peer->contacts(interlocked()); });
  for (Spheres* spheres : {&few, &many}) works.push_back([spheres] { spheres->query(Estimator::raw); });
  const std::vector<double> times = leastTimes(works.size(), kPasses, [&](std::size_t i) { works[i](); });

  std::printf("| %d | %zu | %zu |", wedges, triangles, contacts);
  const double fcl = peers.size() > 1 ? times[1] : std::nan("");
  std::printf(" %.0f | %.0f |", times[0], fcl);
  for (Spheres* spheres : {&few, &many}) {
    const Overlap raw = spheres->query(Estimator::raw);
    std::printf(" %zu | %llu | %.0f | %+.1f | %+.1f |", spheres->count(),
                static_cast<unsigned long long>(raw.pair_count), times[peers.size() + (spheres == &many)],
                100 * (raw.volume / truth.volume - 1),
                100 * (spheres->query(Estimator::volume_true).volume / truth.volume - 1));
  }
  std::printf(" %.2g |\n", 100 * truth.error);
  std::fflush(stdout);
  if (points)
    std::fprintf(points, "%zu %g %g %g %g\n", triangles, times[0], fcl, times[peers.size()], times.back());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Two interlocked Chazelle polyhedra of growing complexity: overlap queries beside triangle-mesh "
      "collision by "
      "Bullet's GImpact and FCL, one core. A Markdown table on stdout.");
  std::vector<int> wedges{2, 4, 8, 16, 32};
  std::size_t fixed = 10000;
  double per_triangle = 32;
  std::string points_path;
  app.add_option("--wedges", wedges, "From below and from above, of each polyhedron")
      ->capture_default_str()
      ->delimiter(',')
      ->check(CLI::Range(1, 1024));
  app.add_option("--spheres", fixed, "Of the packings that stay the same size")->capture_default_str();
  app.add_option("--per-triangle", per_triangle, "Spheres a triangle of the packings that grow")
      ->capture_default_str();
  app.add_option("--points", points_path, "Write triangles and times there, for plots");
  CLI11_PARSE(app, argc, argv);
  const PointsFile points(points_path);
  if (!points.good()) return 1;
  try {
    std::printf("%s", heading("Two interlocked Chazelle polyhedra", argc, argv).c_str());
    std::printf(
        "Times in us, each the least of %zu; spheres with their own radii, volume and wrench. Errors of the "
        "volume "
        "against %zu "
        "samples.\n\n"
        "| wedges | triangles | contacts of the meshes | GImpact | FCL |%s%s sampling error %% |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        kPasses, kSamples, kColumns, kColumns);
    for (const int count : wedges) row(count, fixed, per_triangle, points.get());
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
