// What accuracy costs: query time against the error of the overlap volume, for both estimators, by depth.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "exact_poses.hpp"
#include "innersphere/error.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"
#include "points_file.hpp"
#include "source.hpp"
#include "sweep.hpp"
#include "timing.hpp"
#include "true_overlap.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

constexpr std::array<double, 5> kOverlapBins{0, 0.01, 0.05, 0.15, 1};  // fractions of the solid
constexpr std::size_t kDepths = kOverlapBins.size() - 1;
constexpr std::array<Estimator, 2> kEstimators{Estimator::raw, Estimator::volume_true};
constexpr std::array<const char*, 2> kEstimatorNames{"raw", "volume-true"};

/// The queries of one length and estimator that were equally deep.
struct Cell {
  std::vector<double> error_z, error_other;  ///< |relative error|, of copies turned about z and about others
  std::vector<double> cpu, cuda, pairs;      ///< us, us, number
};
struct Key {
  std::size_t depth, estimator;
  std::uint32_t spheres;
  bool operator<(const Key& other) const {
    return std::tie(depth, estimator, spheres) < std::tie(other.depth, other.estimator, other.spheres);
  }
};
using Cells = std::map<Key, Cell>;

/// Closed forms exist for few overlaps, so those of the project's solids are sampled.
std::vector<ExactPose> sampledPoses(const std::string& name, std::size_t samples) {
  const std::unique_ptr<Solid> solid = solidFrom(name);
  std::vector<ExactPose> poses;
  for (const Vec3d& axis : {Vec3d{0, 0, 1}, Vec3d{1, 2, 3}}) {
    for (const Placement& placement : sweepPoses(solid->bounds(), axis, 12)) {
      const SampledVolume truth = sampledOverlap(*solid, placement, samples);
      if (truth.volume > 0 && truth.error < 1e-3) poses.push_back({placement, truth.volume, {}, {}});
    }
  }
  return poses;
}

double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

std::vector<double> errorsOf(const Cell& cell) {
  std::vector<double> all = cell.error_z;
  all.insert(all.end(), cell.error_other.begin(), cell.error_other.end());
  return all;
}

std::string percent(const std::vector<double>& errors) {
  if (errors.empty()) return "-";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", 100 * meanOf(errors));
  return text.data();
}

class Budget {
 public:
  explicit Budget(std::size_t passes) : passes_(passes), cpu_({Backend::cpu, 1}) {
    if (cudaAvailable()) cuda_ = std::make_unique<QueryContext>(QueryContextOptions{Backend::cuda});
  }

  void add(std::shared_ptr<const Packing> packing, const std::vector<ExactPose>& poses) {
    const CollisionModel model(packing);
    for (std::size_t estimator = 0; estimator < kEstimators.size(); ++estimator) {
      for (const VolumeTrueRadii& prefix : packing->volume_true) {
        if (prefix.count >= 256) add(model, poses, estimator, prefix.count);
      }
    }
  }

  const Cells& cells() const { return cells_; }
  bool hasCuda() const { return cuda_ != nullptr; }

 private:
  void add(const CollisionModel& model, const std::vector<ExactPose>& poses, std::size_t estimator,
           std::uint32_t spheres) {
    const QueryOptions options{Want::wrench, kEstimators[estimator]};
    const auto query = [&](std::size_t i) {
      return PairQuery{
          &model,  &model, placed(model.packing(), {}), placed(model.packing(), poses[i].placement), spheres,
          spheres, 0};
    };
    std::vector<Overlap> overlaps(poses.size());
    const auto cpu = leastTimes(poses.size(), passes_,
                                [&](std::size_t i) { overlaps[i] = cpu_.overlap(query(i), options); });
    std::vector<double> cuda(poses.size());
    if (cuda_) {
      cuda = leastTimes(poses.size(), passes_, [&](std::size_t i) { cuda_->overlap(query(i), options); });
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double share = poses[i].volume / model.packing().solid.volume;
      std::size_t depth = 0;
      while (depth + 1 < kDepths && share >= kOverlapBins[depth + 1]) ++depth;
      Cell& cell = cells_[{depth, estimator, spheres}];
      const bool about_z = poses[i].placement.rotation[8] > 1 - 1e-9;
      (about_z ? cell.error_z : cell.error_other)
          .push_back(std::fabs(overlaps[i].volume / poses[i].volume - 1));
      cell.cpu.push_back(cpu[i]);
      cell.cuda.push_back(cuda[i]);
      cell.pairs.push_back(static_cast<double>(overlaps[i].pair_count));
    }
  }

  std::size_t passes_;
  QueryContext cpu_;
  std::unique_ptr<QueryContext> cuda_;
  Cells cells_;
};

/// The fewest spheres from which on the error stays below a bound.
void printNeeds(const Cells& cells) {
  constexpr std::array<double, 6> kBounds{0.1, 0.05, 0.02, 0.01, 0.005, 0.002};
  std::printf(
      "Spheres of each body for a mean error below (CPU us):\n\n| overlap, %% of the solid | estimator |");
  for (const double bound : kBounds) std::printf(" %g %% |", 100 * bound);
  std::printf("\n|---|---|---|---|---|---|---|---|\n");
  for (std::size_t depth = 0; depth < kDepths; ++depth) {
    for (std::size_t estimator = 0; estimator < kEstimators.size(); ++estimator) {
      std::printf("| %g-%g | %s |", 100 * kOverlapBins[depth], 100 * kOverlapBins[depth + 1],
                  kEstimatorNames[estimator]);
      for (const double bound : kBounds) {
        const Cell* needed = nullptr;
        std::uint32_t spheres = 0;
        for (const auto& [key, cell] : cells) {
          if (key.depth != depth || key.estimator != estimator) continue;
          if (!(meanOf(errorsOf(cell)) < bound)) {
            needed = nullptr;
          } else if (!needed) {
            needed = &cell;
            spheres = key.spheres;
          }
        }
        if (needed) {
          std::printf(" %u (%.0f) |", spheres, median(needed->cpu));
        } else {
          std::printf(" - |");
        }
      }
      std::printf("\n");
    }
  }
  std::printf("\n");
}

void print(const Budget& budget, FILE* points) {
  printNeeds(budget.cells());
  std::printf(
      "| overlap, %% of the solid | estimator | spheres of each | poses | pairs | mean abs. error %% | about "
      "z | about "
      "other axes | CPU us | CUDA us |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [key, cell] : budget.cells()) {
    const std::vector<double> all = errorsOf(cell);
    std::printf("| %g-%g | %s | %u | %zu | %.0f | %.2f | %s | %s | %.1f |", 100 * kOverlapBins[key.depth],
                100 * kOverlapBins[key.depth + 1], kEstimatorNames[key.estimator], key.spheres, all.size(),
                median(cell.pairs), 100 * meanOf(all), percent(cell.error_z).c_str(),
                percent(cell.error_other).c_str(), median(cell.cpu));
    std::printf(budget.hasCuda() ? " %.1f |\n" : " - |\n", median(cell.cuda));
    if (points) {
      std::fprintf(points, "%zu %s %u %g %g %g\n", key.depth, kEstimatorNames[key.estimator], key.spheres,
                   100 * meanOf(all), median(cell.cpu), median(cell.cuda));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Time of overlap queries against the error of their volumes, for plain and volume-true radii, by "
      "depth: how "
      "many spheres and microseconds the accuracy needs. A Markdown table on stdout.");
  std::vector<std::string> sources{"torus", "box", "cylinder", "lbracket"};
  std::size_t spheres = 65536, passes = 3, samples = 1 << 19;
  std::string points_path, device;
  app.add_option("SOLID[=POSES]", sources,
                 "Mesh or packing files, each with a CSV table of poses of its copy with the exact overlaps, "
                 "or names of "
                 "solids, whose overlaps are sampled")
      ->capture_default_str();
  app.add_option("--spheres", spheres, "Of the longest packing; others are its beginnings")
      ->capture_default_str();
  app.add_option("--passes", passes, "Each time is the least of so many runs")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--samples", samples, "Points that an overlap is sampled with")->capture_default_str();
  app.add_option("--points", points_path, "Write the rows there, for plots");
  app.add_option("--device", device, "Name of the GPU, for the head of the table");
  CLI11_PARSE(app, argc, argv);
  const PointsFile points(points_path);
  if (!points.good()) return 1;
  try {
    std::printf("%s", heading("Time against error", argc, argv).c_str());
    if (!device.empty()) std::printf("GPU: %s\n\n", device.c_str());
    Budget budget(passes);
    for (const std::string& item : sources) {
      const std::size_t equals = item.find('=');
      const std::string source = item.substr(0, equals);
      budget.add(packingFrom(source, spheres), equals == std::string::npos
                                                   ? sampledPoses(source, samples)
                                                   : readOverlappingPoses(item.substr(equals + 1)));
    }
    print(budget, points.get());
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
