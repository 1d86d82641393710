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
void align(const Gauge& gauge, Measured& m) {
  const btVector3 normal = normalAlone(m.gap, m.direction);
  const bool parallel = m.gap.normal_a.dot(m.gap.normal_b) > kParallel;
  if (normal.dot(m.direction) > (parallel ? kAligned : kParallel)) return;
  Gap gap;
  gap.triangle_a = m.gap.triangle_a;
  gap.triangle_b = m.gap.triangle_b;
  if (!gauge.measure(m.index, normal, btVector3(0, 0, 0), gap)) return;
  m.direction = normal;
  m.gap = gap;
}

/// Towards the nearest point of the other surface, or, where the surfaces do not oppose each other there, in
/// the direction of the patch.
bool measure(const Gauge& gauge, const btVector3& patch_normal, Measured& m) {
  Gap start;
  const auto measureAlong = [&](const btVector3& direction) {
    m.direction = direction;
    m.gap = start;
    return gauge.measure(m.index, direction, btVector3(0, 0, 0), m.gap);
  };
  btVector3 nearest;
  bool found = gauge.nearest(m.index, nearest, start) && measureAlong(nearest);
  if (gauge.exactB()) return found;
  const bool own = found && opposed(m.gap) && nearest.dot(patch_normal) > kOwnDirection;
  if (!own) found = measureAlong(patch_normal);
  if (found) align(gauge, m);
  return found;
}

/// Where it was measured before.
bool measureAgain(const Gauge& gauge, const Candidates::Line& line, Measured& m) {
  if (line.direction.isZero()) return false;
  m.direction = line.direction;
  if (gauge.exactB()) gauge.nearest(m.index, m.direction, m.gap);
  m.gap.triangle_a = line.triangle_a;
  m.gap.triangle_b = line.triangle_b;
  if (!gauge.measure(m.index, m.direction, btVector3(0, 0, 0), m.gap)) return false;
  if (!gauge.exactB()) align(gauge, m);
  return true;
}

bool isFlat(const Measured& m) {
  return m.gap.curvature_a == 0 && m.gap.curvature_b == 0;
}

/// Too far apart for a contact, until the candidates are searched again. On flat surfaces it is of use all
/// the same: it tells where faces end.
bool isFar(const Measured& m, btScalar separation) {
  return !isFlat(m) && (m.gap.on_a - m.gap.on_b).dot(m.direction) < -separation;
}

Candidates::Line lineOf(const Measured& m) {
  return {m.direction, m.gap.triangle_a, m.gap.triangle_b};
}

/// Whether a corner of a surface is deeper than the place where it was measured.
bool rises(const btVector3& face, btScalar curvature, const btVector3& normal) {
  return curvature == 0 && face.distance2(normal) > kLeans * kLeans;
}

/// The normal turns with the face that it belongs to.
btScalar shareOfA(const Gap& gap, const btVector3& normal) {
  const btScalar from_a = gap.normal_a.distance(normal), from_b = gap.normal_b.distance(normal);
  return from_a + from_b > SIMD_EPSILON ? from_b / (from_a + from_b) : btScalar(0.5);
}

struct Tried {
  Measured measured;
  bool found;
};

/// Measures all candidates of a patch, the first of which is `begin`.
void measureAll(const Candidates& candidates, const Candidates::OfPatch& patch, std::size_t begin, bool again,
                const Gauge& gauge, std::vector<Tried>& tried) {
  tried.reserve(kUsualMeasured);
  tried.resize(patch.end - begin);
  const auto measureOne = [&](std::size_t i) {
    Measured m;
    m.index = candidates.indices[begin + i];
    m.id = gauge.id(m.index);
    const bool found =
        again ? measureAgain(gauge, candidates.lines[begin + i], m) : measure(gauge, patch.normal, m);
    tried[i] = {m, found};
  };
  // Bodies that are linked have many; other pairs are done long before them. Shapes that are no packings
  // remember what they were asked last, and are asked by one thread.
  if (tried.size() >= kMany && !gauge.exactB()) {
    inParallel(tried.size(), measureOne);
  } else {
    for (std::size_t i = 0; i < tried.size(); ++i) measureOne(i);
  }
}

}  // namespace

void measurePoints(Candidates& candidates, std::size_t p, const Gauge& gauge, btScalar separation,
                   std::vector<MeasuredPoint>& found) {
  static thread_local std::vector<Measured> measured, sideways;
  static thread_local std::vector<Tried> tried;
  static thread_local std::vector<std::size_t> places;  // of the measured, among the candidates
  static thread_local std::vector<Gauge::Corner> corners, peaks;
  const Candidates::OfPatch& patch = candidates.patches[p];
  for (std::vector<Measured>* list : {&measured, &sideways}) {
    list->clear();
    list->reserve(kUsualMeasured);
  }
  places.clear();
  places.reserve(kUsualMeasured);
  const bool again = patch.end <= candidates.lines.size();
  const std::size_t begin = p == 0 ? 0 : candidates.patches[p - 1].end;
  measureAll(candidates, patch, begin, again, gauge, tried);
  for (std::size_t k = begin; k < patch.end; ++k) {
    const auto& [m, found] = tried[k - begin];
    if (!again) candidates.lines.emplace_back();
    if (!found) {
      if (!gauge.exactB() || m.gap.triangle_a == Gap::kNone) continue;
      sideways.push_back(m);
      candidates.lines[k] = lineOf(m);
      continue;
    }
    measured.push_back(m);
    places.push_back(k);
    if (again || !isFar(m, separation)) candidates.lines[k] = lineOf(m);
  }
  climb(gauge, separation, measured);
  // From there the climbs start again.
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (measured[i].starts_climb) candidates.lines[places[i]] = lineOf(measured[i]);
  }
  const ContactNormal normals(measured, gauge);
  const std::size_t first = found.size();
  using Kind = MeasuredPoint::Kind;
  const auto add = [&](const Gap& gap, const btVector3& normal, std::uint64_t id, Kind kind) {
    const btScalar depth = (gap.on_a - gap.on_b).dot(normal);
    const bool near = depth > -separation;
    if (near)
      found.push_back({{gap.on_b, normal, depth, id, 0, 0, shareOfA(gap, normal)}, kind, 0, {0, 0, 0}, 0});
    return near;
  };
  const auto isFound = [&](std::uint64_t id) {
    return std::any_of(found.begin(), found.end(), [&](const MeasuredPoint& f) { return f.point.id == id; });
  };
  // Along the normal of the face that it is over.
  const auto addCorner = [&](const Gauge::Corner& corner, bool of_a) {
    return !isFound(corner.id) && add(corner.gap, of_a ? corner.gap.normal_b : corner.gap.normal_a, corner.id,
                                      corner.is_peak ? Kind::corner : Kind::edge);
  };
  const auto addCrossing = [&](const Measured& m, Gauge::Corner& crossing) {
    return gauge.crossing(m.gap, patch.normal, crossing) &&
           (isFound(crossing.id) || add(crossing.gap, crossing.gap.normal_a, crossing.id, Kind::crossing));
  };
  for (const Measured& m : measured) {
    const btVector3 normal = normals.at(m);
    const bool edge_a = rises(m.gap.normal_a, m.gap.curvature_a, normal),
               edge_b = rises(m.gap.normal_b, m.gap.curvature_b, normal);
    const bool flat = isFlat(m);
    const bool faces = !flat || opposed(m.gap);
    corners.clear();
    if (edge_a != edge_b) gauge.corners(m.index, m.gap, normal, edge_a, corners);
    Gauge::Corner crossing;
    const bool crosses = flat && m.gap.normal_a.dot(m.gap.normal_b) < kAligned && addCrossing(m, crossing);
    if (crosses && crossing.is_alone) corners.clear();
    for (const Gauge::Corner& corner : corners) addCorner(corner, edge_a);
    // Where neither face lies flat, a corner of the one may be deep in the other all the same.
    if (edge_a && edge_b && !crosses) {
      for (const bool of_a : {true, false}) {
        const btVector3& face = of_a ? m.gap.normal_b : m.gap.normal_a;
        peaks.clear();
        gauge.corners(m.index, m.gap, face, of_a, peaks);
        for (const Gauge::Corner& corner : peaks) {
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
  for (const Measured& m : sideways) {
    Gauge::Corner crossing;
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
