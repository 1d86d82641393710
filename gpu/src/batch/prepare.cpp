#include "batch/prepare.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/traversal.hpp"
#include "grid/model_impl.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

using core::Mat3;

namespace {

[[noreturn]] void fail(ErrorCode code, std::size_t index, const std::string& what) {
  throw Error(code, "query " + std::to_string(index) + ": " + what);
}

bool finite(const Placement& placement) {
  const auto all = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
  };
  return all(placement.rotation) && all(placement.translation) && std::isfinite(placement.scale);
}

double length(const Vec3d& v) {
  const double squared = dot(v, v);
  return squared > 1e-280 && squared < 1e280 ? std::sqrt(squared) : std::hypot(v.x, v.y, v.z);
}

constexpr int kExponentBias = 1023, kMantissaBits = 52;

/// Equals std::ldexp(1, exponent), where that is a normal number.
double powerOfTwo(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + kExponentBias) << kMantissaBits);
}

/// Equals std::ilogb of a positive normal number.
int exponentOf(double x) {
  return static_cast<int>(std::bit_cast<std::uint64_t>(x) >> kMantissaBits) - kExponentBias;
}

Mat3<double> transposed(const Mat3<double>& a) {
  return {{a.m[0], a.m[3], a.m[6], a.m[1], a.m[4], a.m[7], a.m[2], a.m[5], a.m[8]}};
}

Mat3<double> product(const Mat3<double>& a, const Mat3<double>& b) {
  Mat3<double> c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      c.m[3 * i + j] = a.m[3 * i] * b.m[j] + a.m[3 * i + 1] * b.m[3 + j] + a.m[3 * i + 2] * b.m[6 + j];
  }
  return c;
}

Mat3<double> scaled(const Mat3<double>& a, double s) {
  Mat3<double> b;
  for (int i = 0; i < 9; ++i) b.m[i] = s * a.m[i];
  return b;
}

/// The rotation nearest to a matrix that is one to within 1e-4. Newton's iteration for the polar
/// decomposition squares the error each time, so two steps reach double precision.
Mat3<double> rotation(const Placement& placement, std::size_t index, const std::string& name) {
  constexpr double kTolerance = 1e-4;
  Mat3<double> r;
  std::copy(placement.rotation.begin(), placement.rotation.end(), r.m);
  for (int step = 0; step < 2; ++step) {
    Mat3<double> change = product(transposed(r), r);
    double worst = 0;
    for (int i = 0; i < 9; ++i) {
      const double identity = i % 4 == 0 ? 1 : 0;
      worst = std::max(worst, std::fabs(change.m[i] - identity));
      change.m[i] = 1.5 * identity - 0.5 * change.m[i];
    }
    if (step == 0) {
      const Vec3d x{r.m[0], r.m[1], r.m[2]}, y{r.m[3], r.m[4], r.m[5]}, z{r.m[6], r.m[7], r.m[8]};
      if (!(worst <= kTolerance)) {
        fail(ErrorCode::bad_argument, index,
             "the rotation of " + name + " is off orthonormal by " + std::to_string(worst) +
                 "; put uniform scaling into Placement::scale and normalise the rest");
      }
      if (dot(cross(x, y), z) < 0)
        fail(ErrorCode::bad_argument, index, "the rotation of " + name + " is a reflection");
    }
    r = product(r, change);
  }
  return r;
}

Mat3<double> checkedRotation(const Placement& placement, std::size_t index, const std::string& name) {
  if (!finite(placement))
    fail(ErrorCode::not_finite, index, "the placement of " + name + " has a number that is not finite");
  if (!(placement.scale > 0)) {
    fail(ErrorCode::bad_argument, index,
         "the scale of " + name + " is " + std::to_string(placement.scale) + "; it must be positive");
  }
  return rotation(placement, index, name);
}

/// A body while its query is prepared.
struct Side {
  const core::GridView& grid;
  Mat3<double> matrix;
  double scale;
  double margin;
};

/// Centre of a body's grid relative to the body's origin, in world axes.
Vec3d centreInWorld(const Side& side) {
  const Vec3f& c = side.grid.centre;
  return side.matrix * Vec3d{c.x, c.y, c.z};
}

/// `between`: from the origin of the owner of the grid to that of the query sphere, world axes.
core::Search makeSearch(const Side& searching, const Side& searched, const Vec3d& between,
                        std::size_t index) {
  const Mat3<double> to_owner = scaled(transposed(searched.matrix), 1 / (searched.scale * searched.scale));
  const Vec3f& centre = searched.grid.centre;
  core::Search search;
  search.matrix = product(to_owner, searching.matrix);
  const Vec3d origin = to_owner * between;
  search.offset = origin - Vec3d{centre.x, centre.y, centre.z};

  // Candidates lie within reach of the grid, so their positions are rounded to single precision of that size;
  // the traversal adds up about 20 such roundings. The transform is off by a few of double precision of the
  // longest of its vectors.
  const double ratio = searching.scale / searched.scale;
  const double margin = searching.margin / searched.scale, grid_margin = searched.margin / searched.scale;
  const double reach = searched.grid.radius + margin + grid_margin;
  const double longest =
      ratio * searching.grid.reach + length(origin) + length({centre.x, centre.y, centre.z});
  const double tolerance = reach / (1 << 18) + longest * 0x1p-48;
  if (!(ratio < 1e30) || !(tolerance < 1e30)) {
    fail(ErrorCode::bad_argument, index, "the bodies differ too much in scale");
  }
  search.ratio = static_cast<float>(ratio);
  search.margin = static_cast<float>(margin);
  search.grid_margin = static_cast<float>(grid_margin);
  search.tolerance = static_cast<float>(tolerance);
  return search;
}

/// The ball around all of a body's spheres.
bool ballsMeet(const Side& a, const Side& b, const Vec3d& offset) {
  const Vec3d between = offset + (centreInWorld(b) - centreInWorld(a));
  const double longest = length(offset) + a.scale * a.grid.reach + b.scale * b.grid.reach;
  const double reach =
      a.scale * a.grid.radius + a.margin + b.scale * b.grid.radius + b.margin + 1e-14 * longest;
  return !(length(between) > reach);
}

/// Whether the ball around the query sphere's spheres meets the box around those of the grid.
bool boxMeets(const Side& searching, const Side& searched, const core::Search& search) {
  const Vec3f& c = searching.grid.centre;
  return core::ballMeets(search, searched.grid, {c.x, c.y, c.z, searching.grid.radius});
}

/// Units small enough to keep the smallest lens and large enough for all spheres to overlap all others,
/// symmetric in the bodies where the quantity is.
core::Units makeUnits(const Side& a, const Side& b, std::size_t index) {
  const double ra = a.scale * a.grid.largest + a.margin;
  const double rb = b.scale * b.grid.largest + b.margin;
  const int pair_bits = exponentOf(static_cast<double>(a.grid.count) * static_cast<double>(b.grid.count));
  const double small = std::min(ra, rb);
  const double area = 3.2 * small * small;            // pi r^2, and
  const double volume = 4.2 * small * small * small;  // 4/3 pi r^3, with room for rounding
  const double reach_a = a.scale * a.grid.reach + a.margin;
  const double reach_b = b.scale * b.grid.reach + b.margin;
  const auto unit = [&](double bound) {
    if (!(bound > 1e-270) || !(bound < 1e270)) {
      fail(ErrorCode::bad_argument, index,
           "lengths are too small or too large to be summed; scale the scene towards metres");
    }
    const int coarse_shift = core::kCoarseBits - 1 - exponentOf(bound);
    const int fine_bits = std::min(core::kFineBits, core::kFixedBits - core::kCoarseBits - pair_bits - 1);
    return core::Unit{powerOfTwo(coarse_shift), powerOfTwo(fine_bits), coarse_shift, fine_bits};
  };
  return {unit(volume), unit(volume * reach_a), unit(volume * reach_b), unit(area), unit(volume * (ra + rb))};
}

}  // namespace

const ModelGrid& KnownGrids::of(const CollisionModel& model, std::uint32_t prefix, Estimator estimator,
                                int side) {
  Known& known = known_[side];
  if (known.model != &model || known.prefix != prefix)
    known = {&model, prefix, &model.impl().grid(prefix, estimator)};
  return *known.grid;
}

PreparedQuery prepare(const PairQuery& query, std::size_t index, Estimator estimator, KnownGrids& grids) {
  if (!query.a || !query.b) fail(ErrorCode::bad_argument, index, "a model is a null pointer");
  const Mat3<double> rotation_a = checkedRotation(query.placement_a, index, "A");
  const Mat3<double> rotation_b = checkedRotation(query.placement_b, index, "B");
  if (!std::isfinite(query.margin)) fail(ErrorCode::not_finite, index, "the margin is not finite");
  const double local_margin = query.margin / query.placement_a.scale;
  if (!(query.margin >= 0) || !(local_margin <= 1e15)) {
    fail(
        ErrorCode::bad_argument, index,
        "the margin is " + std::to_string(query.margin) + "; it must be from 0 to 1e15 times the scale of A");
  }

  PreparedQuery prepared;
  prepared.grid_a = &grids.of(*query.a, query.prefix_a, estimator, 0);
  prepared.grid_b = &grids.of(*query.b, query.prefix_b, estimator, 1);
  const double scale_a = query.placement_a.scale, scale_b = query.placement_b.scale;
  const Side a{prepared.grid_a->plan().view, scaled(rotation_a, scale_a), scale_a, query.margin};
  const Side b{prepared.grid_b->plan().view, scaled(rotation_b, scale_b), scale_b, 0};
  const Vec3d offset = query.placement_b.translation - query.placement_a.translation;
  core::Setup& setup = prepared.setup;
  setup.a = {a.grid, 0};
  setup.b = {b.grid, 0};
  setup.frame = {a.matrix, b.matrix, a.scale, b.scale, a.margin, b.margin, offset};
  setup.units = makeUnits(a, b, index);
  if (!ballsMeet(a, b, offset)) return prepared;
  setup.a_in_b = makeSearch(a, b, -1.0 * offset, index);
  setup.b_in_a = makeSearch(b, a, offset, index);
  if (!boxMeets(a, b, setup.a_in_b) || !boxMeets(b, a, setup.b_in_a)) return prepared;
  setup.a.clusters = a.grid.cluster_count;
  setup.b.clusters = b.grid.cluster_count;
  return prepared;
}

void bringToCpu(PreparedQuery& query) {
  if (query.clusters() == 0) return;
  query.setup.a.grid = query.grid_a->onCpu().view();
  query.setup.b.grid = query.grid_b->onCpu().view();
}

}  // namespace innersphere
