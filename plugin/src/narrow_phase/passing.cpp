#include "narrow_phase/passing.hpp"

#include <algorithm>

#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A point of A, or of B, and its way past the other body.
struct Passer {
  bool of_a;
  btVector3 point, from, way;  ///< `from` is where the way begins
};

/// How often a point beside a side that both bodies share is looked for further inside.
constexpr int kSharedSides = 2;

/// Whether the body of the point goes on behind a side of the other one that this point glides along: there
/// it is not beside it. Gears of one width have the ends of their teeth in one plane. Moves the point there.
bool goesOnBehind(const SurfaceProbe& probe, const btVector3& outwards, btScalar graze, Passer& passer) {
  const btVector3 inwards = outwards * (-2 * graze);
  SurfaceQueries::Nearest own;
  if (!probe.nearestWall(passer.of_a, passer.point + inwards, 4 * graze, own) || own.distance > graze)
    return false;
  passer.point += inwards;
  passer.from += inwards;
  return true;
}

/// Whether a point meets the other body, and does not only glide along beside an edge of it, no deeper than
/// `graze`. What it glides along is not the face that has the contact's own `normal`, and is looked for until
/// the side by which it came in, which may bend, is further away.
bool meets(const SurfaceProbe& probe, Passer passer, const btVector3& normal, btScalar graze,
           int shared_sides = 0) {
  const btVector3& way = passer.way;
  const btScalar part = probe.meets(!passer.of_a, passer.from, way);
  if (part > 1) return false;
  if (part < 0) return true;
  const btScalar length = way.length();
  const btVector3 direction = way / length;
  SurfaceQueries::Nearest wall;
  const auto isShallow = [&](const btVector3& place) {
    return probe.nearestWall(!passer.of_a, place, length, wall) && wall.distance > -graze;
  };
  for (btScalar in = 2 * graze; in > 0 && part * length + in < length; in *= 2) {
    if (!isShallow(passer.from + direction * (part * length + in))) return true;
    if (!(btFabs(wall.normal.dot(direction)) < kBesideCosine)) continue;
    if (btFabs(wall.normal.dot(normal)) > kSameManifoldCosine) return true;
    const btVector3 side = wall.normal;
    if (!isShallow(passer.from + way)) return true;
    return shared_sides < kSharedSides && goesOnBehind(probe, side, graze, passer) &&
           meets(probe, passer, normal, graze, shared_sides + 1);
  }
  return true;
}

/// Whether a place in A, or B, is no deeper than `graze` beside the side that it goes along.
bool isBeside(const SurfaceProbe& probe, bool of_a, const btVector3& place, const btVector3& direction,
              btScalar graze) {
  SurfaceQueries::Nearest wall;
  return probe.nearestWall(of_a, place, graze, wall) && wall.distance > -graze &&
         btFabs(wall.normal.dot(direction)) < kBesideCosine;
}

bool passes(const SurfaceProbe& probe, const StepAhead& step, const WeightedPoint& found) {
  const ContactPoint& point = found.point;
  const btScalar graze = btMax(kGrazing * step.size, kGrazingAtRest * step.sunk);
  if (found.both_bend || found.kind == WeightedPoint::Kind::crossing) return false;
  const btVector3 velocity = step.motion.velocityAt(point.on_b);
  const btScalar approach = velocity.dot(point.normal), ahead = kPassingSteps * step.time_step;
  const bool touches = point.depth >= 0;
  if (!(approach * ahead > (touches ? graze : -point.depth))) return false;
  const btVector3 on_a = point.on_b + point.normal * point.depth + found.across;
  if (!(point.depth < graze)) {
    const btVector3 direction = velocity.normalized();
    return isBeside(probe, false, on_a, direction, graze) &&
           isBeside(probe, true, point.on_b, direction, graze);
  }
  // Ways begin outside, further than by rounding.
  const btScalar back = btMax(btScalar(0), (point.depth + graze) / approach);
  const btVector3 before = velocity * -back, way = velocity * (back + ahead);
  return !meets(probe, {true, on_a, on_a + before, way}, point.normal, graze) &&
         !meets(probe, {false, point.on_b, point.on_b - before, -way}, point.normal, graze);
}

}  // namespace

void dropPassing(const SurfaceProbe& probe, const StepAhead& step, std::vector<WeightedPoint>& found) {
  if (step.motion.isSwept()) return;
  found.erase(std::remove_if(found.begin(), found.end(),
                             [&](const WeightedPoint& point) { return passes(probe, step, point); }),
              found.end());
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
