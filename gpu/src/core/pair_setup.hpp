// Brings a pair of bodies into the form that the traversal reads. The CPU and the device compile this alike,
// so a pair that is prepared on either has the same bits.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/setup.hpp"
#include "core/traversal.hpp"

namespace innersphere::core {

/// Says what is wrong with a pair of bodies. batch/prepare has the words.
enum class Fault : std::uint32_t {
  none,
  not_finite,      ///< A number of a placement.
  not_a_rotation,  ///< A matrix is off orthonormal by more than kRotationTolerance.
  reflection,      ///< A matrix has determinant -1.
  last_row,        ///< That of a 4x4 matrix is not 0 0 0 1.
  scales_differ,   ///< The bodies differ too much in scale.
  lengths          ///< Lengths are too small or too large to be summed.
};

/// This is a body while its pair is prepared.
struct Side {
  GridView grid;        ///< Its arrays are not read.
  Mat3<double> matrix;  ///< Scale times rotation.
  double scale;
  double margin;  ///< What every radius grows by [m].
};

inline constexpr double kRotationTolerance = 1e-4;  ///< How far a matrix may be off orthonormal.

/// Returns sqrt(v v), also where the square is no normal number.
INNERSPHERE_HD inline double length(const Vec3d& v) {
  const double squared = dot(v, v);
  if (squared > 1e-280 && squared < 1e280) return sqrt(squared);
  const double x = fabs(v.x), y = fabs(v.y), z = fabs(v.z);
  const double most = x > y ? (x > z ? x : z) : (y > z ? y : z);
  if (!(most > 0) || !(most < INFINITY)) return most;
  const Vec3d scaled{v.x / most, v.y / most, v.z / most};
  return most * sqrt(dot(scaled, scaled));
}

/// Equals std::ilogb of a positive normal number.
INNERSPHERE_HD inline int exponentOf(double x) {
  constexpr int kBias = 1023, kMantissaBits = 52;
  return static_cast<int>(bitsOf(x) >> kMantissaBits) - kBias;
}

/// Returns how far the product of a matrix with its transpose is from the identity, and that product's
/// `change` to a matrix nearer to a rotation.
INNERSPHERE_HD inline double offOrthonormal(const Mat3<double>& r, Mat3<double>& change) {
  change = product(transposed(r), r);
  double worst = 0;
  for (int i = 0; i < 9; ++i) {
    const double identity = i % 4 == 0 ? 1 : 0;
    const double off = fabs(change.m[i] - identity);
    if (!(off <= worst)) worst = off;  // also NaN
    change.m[i] = 1.5 * identity - 0.5 * change.m[i];
  }
  return worst;
}

/// Makes a matrix that is a rotation to within kRotationTolerance the nearest one. Newton's iteration for the
/// polar decomposition squares the error each time, so two steps reach double precision.
INNERSPHERE_HD inline Fault makeRotation(Mat3<double>& r) {
  for (int step = 0; step < 2; ++step) {
    Mat3<double> change;
    const double off = offOrthonormal(r, change);
    if (step == 0) {
      if (!(off <= kRotationTolerance)) return Fault::not_a_rotation;
      const Vec3d x{r.m[0], r.m[1], r.m[2]}, y{r.m[3], r.m[4], r.m[5]}, z{r.m[6], r.m[7], r.m[8]};
      if (dot(cross(x, y), z) < 0) return Fault::reflection;
    }
    r = product(r, change);
  }
  return Fault::none;
}

/// Returns the centre of a body's grid relative to the body's origin, in axes of the world.
INNERSPHERE_HD inline Vec3d centreInWorld(const Side& side) {
  const Vec3f& c = side.grid.centre;
  return side.matrix * Vec3d{c.x, c.y, c.z};
}

/// Makes the search of one body in the grid of the other; `between` goes from the origin of the searched body
/// to that of the searching one, in axes of the world.
INNERSPHERE_HD inline Fault makeSearch(const Side& searching, const Side& searched, const Vec3d& between,
                                       Search& search) {
  const Mat3<double> to_owner = scaled(transposed(searched.matrix), 1 / (searched.scale * searched.scale));
  const Vec3d centre{searched.grid.centre.x, searched.grid.centre.y, searched.grid.centre.z};
  search.matrix = product(to_owner, searching.matrix);
  const Vec3d origin = to_owner * between;
  search.offset = origin - centre;

  // Candidates lie within reach of the grid, so their positions are rounded to single precision of that size;
  // the traversal adds up about 20 such roundings. The transform is off by a few of double precision of the
  // longest of its vectors.
  const double ratio = searching.scale / searched.scale;
  const double margin = searching.margin / searched.scale, grid_margin = searched.margin / searched.scale;
  const double reach = searched.grid.radius + margin + grid_margin;
  const double longest = ratio * searching.grid.reach + length(origin) + length(centre);
  const double tolerance = reach / (1 << 18) + longest * 0x1p-48;
  search.ratio = static_cast<float>(ratio);
  search.margin = static_cast<float>(margin);
  search.grid_margin = static_cast<float>(grid_margin);
  search.tolerance = static_cast<float>(tolerance);
  return ratio < 1e30 && tolerance < 1e30 ? Fault::none : Fault::scales_differ;
}

/// Returns whether the balls around all of both bodies' spheres meet.
INNERSPHERE_HD inline bool ballsMeet(const Side& a, const Side& b, const Vec3d& offset) {
  const Vec3d between = offset + (centreInWorld(b) - centreInWorld(a));
  const double longest = length(offset) + a.scale * a.grid.reach + b.scale * b.grid.reach;
  const double reach =
      a.scale * a.grid.radius + a.margin + b.scale * b.grid.radius + b.margin + 1e-14 * longest;
  return !(length(between) > reach);
}

/// Returns whether the ball around the searching body's spheres meets the box around those of the grid.
INNERSPHERE_HD inline bool boxMeets(const Side& searching, const Side& searched, const Search& search) {
  const Vec3f& c = searching.grid.centre;
  return ballMeets(search, searched.grid, {c.x, c.y, c.z, searching.grid.radius});
}

INNERSPHERE_HD inline Fault makeUnit(double bound, int pair_bits, Unit& unit) {
  if (!(bound > 1e-270) || !(bound < 1e270)) return Fault::lengths;
  const int room = kFixedBits - kCoarseBits - pair_bits - 1;
  unit = unitWith(kCoarseBits - 1 - exponentOf(bound), kFineBits < room ? kFineBits : room);
  return Fault::none;
}

/// Makes units small enough to keep the smallest lens and large enough for all spheres to overlap all others,
/// symmetric in the bodies where the quantity is.
INNERSPHERE_HD inline Fault makeUnits(const Side& a, const Side& b, Units& units) {
  const double ra = a.scale * a.grid.largest + a.margin;
  const double rb = b.scale * b.grid.largest + b.margin;
  const int pair_bits = exponentOf(static_cast<double>(a.grid.count) * static_cast<double>(b.grid.count));
  const double small = ra < rb ? ra : rb;
  const double area = 3.2 * small * small;            // pi r^2, and
  const double volume = 4.2 * small * small * small;  // 4/3 pi r^3, with room for rounding
  const double reach_a = a.scale * a.grid.reach + a.margin;
  const double reach_b = b.scale * b.grid.reach + b.margin;
  const double bounds[] = {volume, volume * reach_a, volume * reach_b, area, volume * (ra + rb)};
  Unit* const all[] = {&units.volume, &units.moment, &units.torque, &units.area, &units.energy};
  for (int i = 0; i < 5; ++i) {
    if (makeUnit(bounds[i], pair_bits, *all[i]) != Fault::none) return Fault::lengths;
  }
  return Fault::none;
}

/// Returns the volume of a body; infinity if it is not known.
INNERSPHERE_HD inline double volumeOf(const Side& side) {
  if (!(side.grid.volume > 0) || side.margin > 0) return INFINITY;
  return side.scale * side.scale * side.scale * side.grid.volume;
}

/// Prepares a pair; `offset` goes from the origin of A to that of B, in axes of the world.
INNERSPHERE_HD inline Fault makePairSetup(const Side& a, const Side& b, const Vec3d& offset,
                                          PairSetup& setup) {
  setup.frame = {a.matrix, b.matrix, a.scale, b.scale, a.margin, b.margin, offset};
  const double volume_a = volumeOf(a), volume_b = volumeOf(b);
  setup.most_volume = volume_a < volume_b ? volume_a : volume_b;
  setup.clusters[0] = setup.clusters[1] = 0;
  Fault fault = makeUnits(a, b, setup.units);
  if (fault != Fault::none || !ballsMeet(a, b, offset)) return fault;
  fault = makeSearch(a, b, -1.0 * offset, setup.searches[0]);
  if (fault == Fault::none) fault = makeSearch(b, a, offset, setup.searches[1]);
  if (fault != Fault::none) return fault;
  if (!boxMeets(a, b, setup.searches[0]) || !boxMeets(b, a, setup.searches[1])) return Fault::none;
  setup.clusters[0] = a.grid.cluster_count;
  setup.clusters[1] = b.grid.cluster_count;
  return Fault::none;
}

}  // namespace innersphere::core
