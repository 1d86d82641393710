#include "narrow_phase/contact_samples.hpp"

#include <algorithm>

#include "common/bullet_vectors.hpp"
#include "common/parallel.hpp"
#include "narrow_phase/contact_normal.hpp"
#include "narrow_phase/deepest_points.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// The nearest point counts if it lies within 60 degrees of the patch's direction.
constexpr btScalar kOwnDirection = btScalar(0.5);
/// A line within 5 degrees of the normal is not drawn again where flat faces meet, which it does not matter
/// to; else one within 0.5 degrees.
constexpr btScalar kAligned = btScalar(0.996);
constexpr btScalar kParallel = btScalar(0.99996);
/// A face that leans more than this does not lie flat on the other: a corner is deeper [rad].
constexpr btScalar kLeans = btScalar(1e-3);
/// Places of a patch from which on several threads measure them.
constexpr std::size_t kMany = 8;
/// What there is room for from the start: few patches have more measurements, and need memory again.
constexpr std::size_t kUsualMeasured = 128;

/// Then along the normal that the surfaces show.
void align(const SurfaceProbe& probe, ProbedSample& m) {
  const btVector3 normal = normalAlone(m.gap, m.direction);
  const bool parallel = m.gap.normal_a.dot(m.gap.normal_b) > kParallel;
  if (normal.dot(m.direction) > (parallel ? kAligned : kParallel)) return;
  OpposedPoints gap;
  gap.triangle_a = m.gap.triangle_a;
  gap.triangle_b = m.gap.triangle_b;
  if (!probe.measure(m.index, normal, btVector3(0, 0, 0), gap)) return;
  m.direction = normal;
  m.gap = gap;
}

/// Towards the nearest point of the other surface, or, where the surfaces do not oppose each other there, in
/// the direction of the patch.
bool measure(const SurfaceProbe& probe, const btVector3& patch_normal, ProbedSample& m) {
  OpposedPoints start;
  const auto measureAlong = [&](const btVector3& direction) {
    m.direction = direction;
    m.gap = start;
    return probe.measure(m.index, direction, btVector3(0, 0, 0), m.gap);
  };
  btVector3 nearest;
  bool found = probe.nearest(m.index, nearest, start) && measureAlong(nearest);
  if (probe.exactB()) return found;
  const bool own = found && opposed(m.gap) && nearest.dot(patch_normal) > kOwnDirection;
  if (!own) found = measureAlong(patch_normal);
  if (found) align(probe, m);
  return found;
}

/// Where it was measured before.
bool measureAgain(const SurfaceProbe& probe, const Samples::Line& line, ProbedSample& m) {
  if (line.direction.isZero()) return false;
  m.direction = line.direction;
  if (probe.exactB()) probe.nearest(m.index, m.direction, m.gap);
  m.gap.triangle_a = line.triangle_a;
  m.gap.triangle_b = line.triangle_b;
  if (!probe.measure(m.index, m.direction, btVector3(0, 0, 0), m.gap)) return false;
  if (!probe.exactB()) align(probe, m);
  return true;
}

bool isFlat(const ProbedSample& m) {
  return m.gap.curvature_a == 0 && m.gap.curvature_b == 0;
}

/// Too far apart for a contact, until the samples are searched again. On flat surfaces it is of use all
/// the same: it tells where faces end.
bool isFar(const ProbedSample& m, btScalar separation) {
  return !isFlat(m) && (m.gap.on_a - m.gap.on_b).dot(m.direction) < -separation;
}

Samples::Line lineOf(const ProbedSample& m) {
  return {m.direction, m.gap.triangle_a, m.gap.triangle_b};
}

/// Whether a corner of a surface is deeper than the place where it was measured.
bool rises(const btVector3& face, btScalar curvature, const btVector3& normal) {
  return curvature == 0 && face.distance2(normal) > kLeans * kLeans;
}

/// The normal turns with the face that it belongs to.
btScalar shareOfA(const OpposedPoints& gap, const btVector3& normal) {
  const btScalar from_a = gap.normal_a.distance(normal), from_b = gap.normal_b.distance(normal);
  return from_a + from_b > SIMD_EPSILON ? from_b / (from_a + from_b) : btScalar(0.5);
}

struct Tried {
  ProbedSample measured;
  bool found;
};

/// Measures all samples of a patch, the first of which is `begin`.
void measureAll(const Samples& samples, const Samples::OfPatch& patch, std::size_t begin, bool again,
                const SurfaceProbe& probe, std::vector<Tried>& tried) {
  tried.reserve(kUsualMeasured);
  tried.resize(patch.end - begin);
  const auto measureOne = [&](std::size_t i) {
    ProbedSample m;
    m.index = samples.indices[begin + i];
    m.id = probe.id(m.index);
    const bool found =
        again ? measureAgain(probe, samples.lines[begin + i], m) : measure(probe, patch.normal, m);
    tried[i] = {m, found};
  };
  // Bodies that are linked have many; other pairs are done long before them. Shapes that are no packings
  // remember what they were asked last, and are asked by one thread.
  if (tried.size() >= kMany && !probe.exactB()) {
    inParallel(tried.size(), measureOne);
  } else {
    for (std::size_t i = 0; i < tried.size(); ++i) measureOne(i);
  }
}

}  // namespace

void findContactPoints(Samples& samples, std::size_t p, const SurfaceProbe& probe, btScalar separation,
                       std::vector<WeightedPoint>& found) {
  static thread_local std::vector<ProbedSample> measured, sideways;
  static thread_local std::vector<Tried> tried;
  static thread_local std::vector<std::size_t> places;  // of the measured, among the samples
  static thread_local std::vector<SurfaceProbe::Corner> corners, peaks;
  const Samples::OfPatch& patch = samples.patches[p];
  for (std::vector<ProbedSample>* list : {&measured, &sideways}) {
    list->clear();
    list->reserve(kUsualMeasured);
  }
  places.clear();
  places.reserve(kUsualMeasured);
  const bool again = patch.end <= samples.lines.size();
  const std::size_t begin = p == 0 ? 0 : samples.patches[p - 1].end;
  measureAll(samples, patch, begin, again, probe, tried);
  for (std::size_t k = begin; k < patch.end; ++k) {
    const auto& [m, found] = tried[k - begin];
    if (!again) samples.lines.emplace_back();
    if (!found) {
      if (!probe.exactB() || m.gap.triangle_a == OpposedPoints::kNone) continue;
      sideways.push_back(m);
      samples.lines[k] = lineOf(m);
      continue;
    }
    measured.push_back(m);
    places.push_back(k);
    if (again || !isFar(m, separation)) samples.lines[k] = lineOf(m);
  }
  climb(probe, separation, measured);
  // From there the climbs start again.
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (measured[i].starts_climb) samples.lines[places[i]] = lineOf(measured[i]);
  }
  const ContactNormal normals(measured, probe);
  const std::size_t first = found.size();
  using Kind = WeightedPoint::Kind;
  const auto add = [&](const OpposedPoints& gap, const btVector3& normal, std::uint64_t id, Kind kind) {
    const btScalar depth = (gap.on_a - gap.on_b).dot(normal);
    const bool near = depth > -separation;
    if (near)
      found.push_back({{gap.on_b, normal, depth, id, 0, 0, shareOfA(gap, normal)}, kind, 0, {0, 0, 0}, 0});
    return near;
  };
  const auto isFound = [&](std::uint64_t id) {
    return std::any_of(found.begin(), found.end(), [&](const WeightedPoint& f) { return f.point.id == id; });
  };
  // Along the normal of the face that it is over.
  const auto addCorner = [&](const SurfaceProbe::Corner& corner, bool of_a) {
    return !isFound(corner.id) && add(corner.gap, of_a ? corner.gap.normal_b : corner.gap.normal_a, corner.id,
                                      corner.is_peak ? Kind::corner : Kind::edge);
  };
  const auto addCrossing = [&](const ProbedSample& m, SurfaceProbe::Corner& crossing) {
    return probe.crossing(m.gap, patch.normal, crossing) &&
           (isFound(crossing.id) || add(crossing.gap, crossing.gap.normal_a, crossing.id, Kind::crossing));
  };
  for (const ProbedSample& m : measured) {
    const btVector3 normal = normals.at(m);
    const bool edge_a = rises(m.gap.normal_a, m.gap.curvature_a, normal),
               edge_b = rises(m.gap.normal_b, m.gap.curvature_b, normal);
    const bool flat = isFlat(m);
    const bool faces = !flat || opposed(m.gap);
    corners.clear();
    if (edge_a != edge_b) probe.corners(m.index, m.gap, normal, edge_a, corners);
    SurfaceProbe::Corner crossing;
    const bool crosses = flat && m.gap.normal_a.dot(m.gap.normal_b) < kAligned && addCrossing(m, crossing);
    if (crosses && crossing.is_alone) corners.clear();
    for (const SurfaceProbe::Corner& corner : corners) addCorner(corner, edge_a);
    // Where neither face lies flat, a corner of the one may be deep in the other all the same.
    if (edge_a && edge_b && !crosses) {
      for (const bool of_a : {true, false}) {
        const btVector3& face = of_a ? m.gap.normal_b : m.gap.normal_a;
        peaks.clear();
        probe.corners(m.index, m.gap, face, of_a, peaks);
        for (const SurfaceProbe::Corner& corner : peaks) {
          if (corner.is_peak && addCorner(corner, of_a)) corners.push_back(corner);
        }
      }
    }
    // Beside them the face is less deep, or, where it ends in an arc, not there.
    if (corners.empty() && !crosses && add(m.gap, normal, m.id, faces ? Kind::faces : Kind::edge)) {
      found.back().point.curvature_a = m.gap.curvature_a;
      found.back().point.curvature_b = m.gap.curvature_b;
    }
  }
  for (const ProbedSample& m : sideways) {
    SurfaceProbe::Corner crossing;
    if (isFlat(m)) addCrossing(m, crossing);
  }
  btVector3 centre(0, 0, 0);
  for (std::size_t i = first; i < found.size(); ++i) centre += found[i].point.on_b;
  for (std::size_t i = first; i < found.size(); ++i) {
    const btScalar count = btScalar(found.size() - first);
    found[i].area = patch.area / count;
    found[i].centre = centre / count;
    found[i].radius = patch.radius;
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
