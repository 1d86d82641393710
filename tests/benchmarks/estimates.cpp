// Whether the errors that packings foretell hold: foretold and measured ones, by depth, for copies and for
// pairs of different solids, in poses that the packer did not see.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "innersphere/bounded_query.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solid.hpp"
#include "machine.hpp"
#include "source.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

// Parts of the solid; then where copies lie nearly upon it, where they are moved by about as much, and where
// one is inside another.
const std::vector<double> kCells{1e-4, 3e-4, 0.001, 0.003, 0.01, 0.03, 0.1, 1},
    kDeepCells{0.45, 0.6, 0.8, 0.95, 1}, kNearCells{0.1, 0.45, 0.6, 0.8, 0.95, 0.999, 1},
    kInsideCells{0.1, 0.25, 0.45, 0.7, 0.9, 1};
constexpr std::array<std::uint32_t, 3> kCounts{256, 1024, 4096};
constexpr std::size_t kFewest = 30;  // poses of a cell that says anything
constexpr double kNestedTurn = 20;   // one over the tangent of half the angle: 6 degrees

constexpr double kLeastNear = 0.003, kMostNear = 0.02;  // turns [rad] and shifts [half diagonals]

enum class Kind { any, nested, flush, deep, near, inside };

/// Which poses to draw, and how large B is against A, by the diagonals of their boxes.
struct Drawn {
  Kind kind = Kind::any;
  double size = 1;
};

struct Body {
  std::string name;
  std::shared_ptr<const Solid> solid;
  std::shared_ptr<const CollisionModel> model;
  double diagonal, volume;
};

/// Random rotations and directions, and what two bodies share in such poses. Nested: B is turned by a few
/// degrees at most, and moved from where it lies upon A, as cups stand in each other. Deep: by a third moved
/// only, by a third turned only, and by no more than leaves 45 to 100 % shared. Near: turned and moved by 0.3
/// to 2 %, whatever is shared. Flush: a face of B lies on a face of A, turned about its normal by half.
/// Inside: turned at random, a random point of B on one of A.
class Poses {
 public:
  Poses(const Body& a, const Body& b, const Drawn& drawn)
      : a_(a), b_(b), kind_(drawn.kind), context_({Backend::cpu, 1}) {
    query_.a = a.model.get();
    query_.b = b.model.get();
    query_.placement_b.scale = drawn.size * a.diagonal / b.diagonal;
    whole_ = std::min(a.volume, b.volume * std::pow(query_.placement_b.scale, 3));
  }

  /// The volume of the smaller body.
  double whole() const { return whole_; }

  /// Turns B, puts a point of it on one of A, and moves it away until the true volume is a part of the
  /// smaller body, if it is not less from the start. Returns the volume.
  double next() {
    if (kind_ == Kind::deep) return nextDeep();
    if (kind_ == Kind::near) return nextNear();
    if (kind_ == Kind::inside) return nextInside();
    std::uniform_real_distribution<double> part(std::log(1e-5), std::log(0.45));
    const double wanted = std::exp(part(random_)) * whole_;
    Vec3d way;
    double near = 0, far = 2.1;
    if (kind_ == Kind::flush) {
      way = a_.diagonal * layFaceOnFace();
      // It touches and no more, so it is pushed in first.
      for (double push = 1e-4; volumeAt(near, way) < wanted && push < 0.3; push *= 2) {
        far = near;
        near = -push;
      }
    } else {
      turn();
      from_ = pointIn(a_);
      to_ = kind_ == Kind::nested ? from_ : pointIn(b_);
      way = a_.diagonal * direction();
    }
    for (int step = 0; step < 18; ++step) {
      const double middle = (near + far) / 2;
      (volumeAt(middle, way) > wanted ? near : far) = middle;
    }
    place(near, way);
    return context_.overlap(query_, {Want::volume, Estimator::surface}).volume;
  }

  double found(std::uint32_t count, ExpectedError& expected) {
    PairQuery query = query_;
    query.prefix_a = query.prefix_b = count;
    const Overlap overlap = context_.overlap(query, {Want::wrench, Estimator::volume_true});
    expected = expectedError(query, Estimator::volume_true, overlap);
    return overlap.volume;
  }

 private:
  double nextDeep() {
    std::uniform_real_distribution<double> part;
    const double wanted = (0.45 + 0.55 * part(random_)) * whole_;
    from_ = to_ = pointIn(a_);
    const int third = static_cast<int>(3 * part(random_));
    const Vec3d axis = direction(), way = (third == 1 ? 0 : a_.diagonal * part(random_)) * direction();
    const double angle = third == 0 ? 0 : part(random_);
    double small = 0, large = 1, volume = 0;
    for (int step = 0; step < 14; ++step) {
      const double size = step == 0 ? 1 : (small + large) / 2, s = std::sin(size * angle / 2);
      turn(std::cos(size * angle / 2), s * axis[0], s * axis[1], s * axis[2]);
      place(size, way);
      volume = context_.overlap(query_, {Want::volume, Estimator::surface}).volume;
      if (std::abs(volume - wanted) < 0.02 * whole_ || (step == 0 && volume > wanted)) break;
      (volume > wanted ? small : large) = size;
    }
    return volume;
  }

  double nextNear() {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> part(std::log(kLeastNear), std::log(kMostNear));
    const double size = std::exp(part(random_));
    const auto any = [&] { return Vec3d{normal(random_), normal(random_), normal(random_)}; };
    const Vec3d axis = size / 2 * any();
    turn(1, axis[0], axis[1], axis[2]);
    from_ = to_ = a_.model->packing().solid.centre_of_mass;
    place(size * a_.diagonal / 2, any());
    return context_.overlap(query_, {Want::volume, Estimator::surface}).volume;
  }

  /// Turns B so that a face of it lies on a face of A, by half without any other turn, where it has a face
  /// for that. Returns the normal outwards.
  Vec3d layFaceOnFace() {
    const Face on = faceOf(a_);
    from_ = on.point;
    Face of = faceOf(b_);
    if (std::bernoulli_distribution()(random_)) {
      for (int i = 0; i < 100 && dot(of.normal, on.normal) > -1 + 1e-6; ++i) of = faceOf(b_);
      if (dot(of.normal, on.normal) <= -1 + 1e-6) {
        to_ = of.point;
        turn(1, 0, 0, 0);
        return on.normal;
      }
    }
    to_ = of.point;
    const auto frame = [this](const Vec3d& normal) {
      const Vec3d any = direction(), flat = any - dot(any, normal) * normal, u = (1 / norm(flat)) * flat;
      return std::array<Vec3d, 3>{u, cross(normal, u), normal};
    };
    const std::array<Vec3d, 3> to = frame(-1.0 * on.normal), from = frame(of.normal);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        double& entry = query_.placement_b.rotation[3 * i + j];
        entry = 0;
        for (std::size_t k = 0; k < 3; ++k) entry += to[k][i] * from[k][j];
      }
    }
    return on.normal;
  }

  struct Face {
    Vec3d point, normal;
  };

  /// A random point of the surface, evenly spread.
  Face faceOf(const Body& body) {
    const Surface& surface = body.model->packing().surface;
    const auto at = [&](std::size_t triangle, std::size_t corner) {
      const auto& v = surface.vertices[surface.triangles[triangle][corner]];
      return Vec3d{v[0], v[1], v[2]};
    };
    const auto turned = [&](std::size_t i) { return cross(at(i, 1) - at(i, 0), at(i, 2) - at(i, 0)); };
    std::vector<double> sums;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i)
      sums.push_back((sums.empty() ? 0 : sums.back()) + norm(turned(i)));
    std::uniform_real_distribution<double> part;
    const double wanted = part(random_) * sums.back();
    const auto i =
        static_cast<std::size_t>(std::lower_bound(sums.begin(), sums.end(), wanted) - sums.begin());
    const double s = std::sqrt(part(random_)), t = part(random_);
    const Vec3d normal = turned(i);
    return {(1 - s) * at(i, 0) + s * (1 - t) * at(i, 1) + s * t * at(i, 2), (1 / norm(normal)) * normal};
  }

  double nextInside() {
    turn();
    from_ = pointIn(a_);
    to_ = pointIn(b_);
    place(0, {});
    return context_.overlap(query_, {Want::volume, Estimator::surface}).volume;
  }

  Vec3d direction() {
    std::normal_distribution<double> normal;
    const Vec3d way{normal(random_), normal(random_), normal(random_)};
    return (1 / norm(way)) * way;
  }

  void turn() {
    std::normal_distribution<double> normal;
    double w = normal(random_), x = normal(random_), y = normal(random_), z = normal(random_);
    if (kind_ == Kind::nested) w = kNestedTurn * std::hypot(x, y, z);
    turn(w, x, y, z);
  }

  void turn(double w, double x, double y, double z) {
    const double length = std::hypot(std::hypot(w, x), std::hypot(y, z));
    w /= length, x /= length, y /= length, z /= length;
    query_.placement_b.rotation = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                                   2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                                   2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
  }

  /// A random point of a body, evenly spread.
  Vec3d pointIn(const Body& body) {
    const Bounds box = body.solid->bounds();
    for (;;) {
      Vec3d point{};
      for (int k = 0; k < 3; ++k)
        point[k] = std::uniform_real_distribution<double>(box.min[k], box.max[k])(random_);
      if (body.solid->contains(point)) return point - body.model->packing().origin;
    }
  }

  void place(double distance, const Vec3d& way) {
    const Placement& at = query_.placement_b;
    const Mat3d& r = at.rotation;
    Vec3d turned{};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) turned[i] += at.scale * r[3 * i + j] * to_[j];
    }
    query_.placement_b.translation = from_ - turned + distance * way;
  }

  double volumeAt(double distance, const Vec3d& way) {
    place(distance, way);
    const double by_spheres = context_.overlap(query_, {Want::volume, Estimator::volume_true}).volume;
    if (by_spheres > 0.02 * whole_) return by_spheres;  // deep: the surface would take long
    return context_.overlap(query_, {Want::volume, Estimator::surface}).volume;
  }

  const Body &a_, &b_;
  Kind kind_;
  QueryContext context_;
  PairQuery query_;
  double whole_;
  Vec3d from_, to_;  ///< points of A and of B that coincide at distance 0
  std::mt19937_64 random_{12345};
};

/// What was foretold and measured in poses that are equally deep.
struct Cell {
  std::size_t poses = 0, beyond_bound = 0;
  double foretold = 0, measured = 0;

  void add(double error, const ExpectedError& expected) {
    ++poses;
    beyond_bound += error > expected.bound;
    foretold += expected.mean;
    measured += error;
  }
};

/// Counts the cells that do not hold.
struct Verdict {
  std::size_t cells = 0, below = 0, far_above = 0, poses = 0, beyond_bound = 0;

  void add(const Cell& cell) {
    ++cells;
    below += cell.foretold < cell.measured;
    far_above += cell.foretold > 3 * cell.measured;
    poses += cell.poses;
    beyond_bound += cell.beyond_bound;
  }
  void print(const char* of) const {
    std::printf("| %s | %zu | %zu (%.1f %%) | %zu | %zu | %.1f %% |\n", of, cells, below,
                100.0 * static_cast<double>(below) / static_cast<double>(cells), far_above, poses,
                100.0 * static_cast<double>(beyond_bound) / static_cast<double>(poses));
  }
};

const std::vector<double>& cellsOf(Kind kind) {
  if (kind == Kind::deep) return kDeepCells;
  if (kind == Kind::near) return kNearCells;
  return kind == Kind::inside ? kInsideCells : kCells;
}

void printPair(const Body& a, const Body& b, const Drawn& drawn, std::size_t poses, Verdict& verdict,
               Verdict& of_bare) {
  Poses all(a, b, drawn);
  const std::vector<double>& cells = cellsOf(drawn.kind);
  std::array<std::vector<Cell>, kCounts.size()> table;
  table.fill(std::vector<Cell>(cells.size() - 1));
  for (std::size_t i = 0; i < poses; ++i) {
    const double truth = all.next();
    if (!(truth > 0)) continue;
    for (std::size_t k = 0; k < kCounts.size(); ++k) {
      ExpectedError expected;
      const double found = all.found(kCounts[k], expected);
      if (found < cells[0] * all.whole() || std::isnan(expected.mean)) continue;
      std::size_t cell = 0;
      while (cell + 2 < cells.size() && found >= cells[cell + 1] * all.whole()) ++cell;
      table[k][cell].add(std::abs(found - truth) / std::max(found, truth), expected);
    }
  }
  const std::string name = &a == &b ? a.name : a.name + ", " + b.name;
  for (std::size_t k = 0; k < kCounts.size(); ++k) {
    const bool bare = !bareSurface(a.model->packing(), kCounts[k]).empty() ||
                      !bareSurface(b.model->packing(), kCounts[k]).empty();
    std::printf("| %s | %u%s |", name.c_str(), kCounts[k], bare ? ", bare" : "");
    std::size_t beyond = 0, any = 0;
    for (const Cell& cell : table[k]) {
      beyond += cell.beyond_bound;
      any += cell.poses;
      if (cell.poses < kFewest) {
        std::printf(" |");
        continue;
      }
      (bare ? of_bare : verdict).add(cell);
      const double count = static_cast<double>(cell.poses) / 100, ratio = cell.foretold / cell.measured;
      std::printf(" %s%.3g / %.3g%s |", ratio < 1 || ratio > 3 ? "**" : "", cell.foretold / count,
                  cell.measured / count, ratio < 1 || ratio > 3 ? "**" : "");
    }
    std::printf(" %.1f |\n", 100.0 * static_cast<double>(beyond) / static_cast<double>(any));
  }
  std::fflush(stdout);
}

/// Packs a solid; "solid:coverage" in that order.
Body bodyOf(const std::string& source) {
  const std::size_t colon = source.rfind(":coverage");
  PackOptions options;
  options.spheres = kCounts.back();
  if (colon != std::string::npos) options.order = SphereOrder::coverage;
  const std::shared_ptr<const Solid> solid = solidFrom(source.substr(0, colon));
  const auto packing = std::make_shared<const Packing>(pack(*solid, options));
  const Bounds box = boxOf(*packing);
  return {plainName(source), solid, std::make_shared<CollisionModel>(packing), norm(box.max - box.min),
          packing->solid.volume};
}

void run(const std::vector<std::string>& sources, const Drawn& drawn, std::size_t poses) {
  const std::vector<double>& cells = cellsOf(drawn.kind);
  std::vector<Body> bodies;
  for (const std::string& source : sources) bodies.push_back(bodyOf(source));
  std::printf("| solid | spheres |");
  for (std::size_t k = 0; k + 1 < cells.size(); ++k)
    std::printf(" %g-%g %% |", 100 * cells[k], 100 * cells[k + 1]);
  std::printf(" beyond |\n|---|---|");
  for (std::size_t k = 0; k < cells.size(); ++k) std::printf("---|");
  std::printf("\n");
  Verdict copies, pairs, bare;
  for (const Body& body : bodies) printPair(body, body, drawn, poses, copies, bare);
  const bool has_pairs = bodies.size() > 1 && (drawn.kind == Kind::any || drawn.kind == Kind::inside);
  for (std::size_t i = 0; i < bodies.size() && has_pairs; ++i)
    printPair(bodies[i], bodies[(i + 1) % bodies.size()], drawn, poses, pairs, bare);
  std::printf(
      "\n| | cells | foretold below measured | more than 3 times above | poses | single errors beyond their "
      "bound "
      "|\n|---|---|---|---|---|---|\n");
  copies.print("a solid and its copy");
  if (has_pairs) pairs.print(drawn.size == 1 ? "two solids of one size" : "a solid in another");
  if (bare.cells > 0) bare.print("either, with too few spheres by the packing's own warning");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Foretold and measured errors of overlap volumes, as Markdown tables on stdout");
  std::vector<std::string> sources;
  std::size_t poses = 500;
  bool nested = false, deep = false, near = false, flush = false;
  double size = 0;
  app.add_option("SOLID", sources, "Mesh files or names of solids; with :coverage behind it, in that order")
      ->required();
  app.add_option("--poses", poses, "Poses of each solid, and of each pair")->capture_default_str();
  app.add_flag("--nested", nested, "Copies that lie nearly upon each other, instead of any poses and pairs");
  app.add_flag("--deep", deep, "Copies that share 45 to 100 %, instead of any poses and pairs");
  app.add_flag("--near", near, "Copies turned and moved by 0.3 to 2 %, instead of any poses and pairs");
  app.add_flag("--flush", flush, "Copies of which a face lies on a face, instead of any poses and pairs");
  app.add_option(
      "--inside", size,
      "A copy of so many times the size, and the next solid as large, in each, instead of poses that "
      "touch more often than not");
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", heading("Foretold and measured errors", argc, argv).c_str());
    std::printf(
        "Mean |error| of the volume relative to the larger of found and true, %% foretold / %% measured, by "
        "the part of the smaller solid that was "
        "found; beyond: single errors beyond their bound, %%.\n\n");
    Drawn drawn{deep     ? Kind::deep
                : nested ? Kind::nested
                : near   ? Kind::near
                : flush  ? Kind::flush
                         : Kind::any};
    if (size > 0) drawn = {Kind::inside, size};
    run(sources, drawn, poses);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
