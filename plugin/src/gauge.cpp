#include "gauge.hpp"

#include <algorithm>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A surface that is met at a flatter angle than 30 degrees is the side of the solid, not the face in
/// contact.
constexpr btScalar kFacing = btScalar(0.5);
/// Normals within 5 degrees are those of one face; a place this deep, in spheres, is under it.
constexpr btScalar kSameFace = btScalar(0.996);
constexpr btScalar kSunk = btScalar(0.1);
constexpr std::uint64_t kCornerId = std::uint64_t(1) << 62;

/// A point of a body's surface, relative to the body's origin, axes of the world.
struct SurfacePoint {
  btVector3 at{0, 0, 0};
  btVector3 normal{0, 0, 0};  ///< unit, out of the solid
  btScalar facing = 0;        ///< cosine between the triangle's normal and the ray
  btScalar curvature = 0;     ///< [1/m]
  std::size_t triangle = 0;
};

/// In the frame of a surface.
struct Ray {
  Ray(const PackingBody& body, const btVector3& start, const btVector3& way, btScalar length)
      : from((start * body.world.getBasis()) / body.scale()),
        direction(way * body.world.getBasis()),
        reach(length / body.scale()) {}
  btVector3 from;
  btVector3 direction;
  btScalar reach;
};

SurfacePoint pointOf(const PackingBody& body, const SurfaceTree::Hit& hit, const btVector3& from,
                     const btVector3& direction) {
  const btMatrix3x3& axes = body.world.getBasis();
  SurfacePoint point;
  point.normal = axes * hit.normal;
  point.curvature = hit.curvature / body.scale();
  point.triangle = hit.triangle;
  point.facing = (axes * hit.face).dot(direction);
  point.at = from + direction * (hit.distance * body.scale());
  return point;
}

/// Where a ray from inside the solid leaves it; through triangle `known`, if it does.
bool leave(const PackingBody& body, const btVector3& from, const btVector3& direction, btScalar reach,
           std::size_t known, SurfacePoint& point) {
  const SurfaceTree& tree = body.shape().surfaceTree();
  const Ray ray(body, from, direction, reach);
  SurfaceTree::Hit hit;
  const bool again =
      known != Gap::kNone && tree.castAt(known, ray.from, ray.direction, ray.reach, hit) && hit.distance > 0;
  if (!again && !tree.cast(ray.from, ray.direction, ray.reach, hit)) return false;
  point = pointOf(body, hit, from, direction);
  if (point.facing < kFacing) return false;
  point.at += direction * body.margin;
  return true;
}

/// Where the line of a ray enters the solid: ahead of it, or behind if it starts inside; through triangle
/// `known`, if it does.
bool enter(const PackingBody& body, const btVector3& from, const btVector3& direction, btScalar reach,
           std::size_t known, SurfacePoint& point) {
  const SurfaceTree& tree = body.shape().surfaceTree();
  const Ray ray(body, from, direction, reach);
  SurfaceTree::Hit hit;
  if (known != Gap::kNone && tree.castAt(known, ray.from, ray.direction, ray.reach, hit)) {
    point = pointOf(body, hit, from, direction);
  } else {
    if (!tree.cast(ray.from, ray.direction, ray.reach, hit)) return false;
    point = pointOf(body, hit, from, direction);
    if (point.facing > 0) {
      if (!tree.cast(ray.from, -ray.direction, ray.reach, hit)) return false;
      point = pointOf(body, hit, from, -direction);
      point.facing = -point.facing;
    }
  }
  if (point.facing > -kFacing) return false;
  point.at -= direction * body.margin;
  return true;
}

/// Whether a face with this normal is at a place. `size` is that of the things looked at.
bool faceAt(const PackingBody& body, const btVector3& at, const btVector3& normal, btScalar size) {
  const btMatrix3x3& axes = body.world.getBasis();
  // A little inside, where the direction to the face is well defined.
  const btVector3 place = at - normal * (kSunk * size + body.margin);
  NearestTriangle::Result nearest;
  return body.shape().nearestTriangle().find((place * axes) / body.scale(), size / body.scale(), nearest) &&
         nearest.distance < 0 && (axes * nearest.normal).dot(normal) > kSameFace;
}

/// Corners uphill from a triangle, relative to the body's origin, for which over(at) holds.
template <typename Over>
void appendCorners(const PackingBody& body, std::size_t triangle, const btVector3& direction,
                   const btVector3& start, btScalar reach, std::uint64_t first_id, const Over& over,
                   std::vector<Gauge::Corner>& corners) {
  static thread_local std::vector<std::uint32_t> vertices;
  const btMatrix3x3& axes = body.world.getBasis();
  vertices.clear();
  body.shape().vertexClimb().from(triangle, direction * axes, (start * axes) / body.scale(),
                                  reach / body.scale(), vertices);
  for (std::uint32_t v : vertices) {
    const btVector3 vertex = axes * (toBullet(body.shape().packing().surface.vertices[v]) * body.scale());
    const Gauge::Corner corner{vertex + direction * body.margin, first_id + 2 * std::uint64_t(v)};
    if (over(corner.at)) corners.push_back(corner);
  }
}

}  // namespace

bool SurfaceGauge::measure(std::size_t index, const btVector3&, const btVector3& shift, Gap& gap) const {
  const Touch& touch = touches_[index];
  const btScalar radius = a_.ownRadius(touch.sphere);
  // Only of a flat surface it is known what it is like beside the nearest point.
  if (shift.length2() > 0 && (touch.curvature != 0 || shift.length() > radius + a_.slack)) return false;
  const btVector3 from = a_.centreOf(touch.sphere) + shift;
  const btVector3 towards_b = -touch.normal;
  SurfacePoint on_a;
  if (!leave(a_, from, towards_b, 2 * (radius + a_.slack), gap.triangle_a, on_a)) return false;
  gap.on_a = on_a.at;
  gap.normal_a = on_a.normal;
  gap.curvature_a = on_a.curvature;
  gap.triangle_a = on_a.triangle;
  gap.on_b = from + towards_b * touch.distance;
  gap.normal_b = towards_b;
  gap.curvature_b = touch.curvature;
  return true;
}

bool SurfaceGauge::nearest(std::size_t index, btVector3& direction) const {
  direction = -touches_[index].normal;
  return true;
}

void SurfaceGauge::corners(std::size_t index, const Gap& gap, const btVector3& normal, bool of_a,
                           std::vector<Corner>& corners) const {
  if (!of_a) return;
  const auto reachOf = [&](const Touch& touch) { return a_.ownRadius(touch.sphere) + a_.slack; };
  // The face is known where spheres are near it.
  const auto over = [&](const btVector3& at) {
    return std::any_of(touches_.begin(), touches_.end(), [&](const Touch& touch) {
      const btScalar reach = reachOf(touch);
      return a_.centreOf(touch.sphere).distance2(at) < reach * reach && touch.normal.dot(-normal) > kSameFace;
    });
  };
  appendCorners(a_, gap.triangle_a, normal, gap.on_a, reachOf(touches_[index]), kCornerId, over, corners);
}

Gauge::Forward SurfaceGauge::forward(std::size_t index, const btVector3&) const {
  const Touch& touch = touches_[index];
  return {true, a_.ownRadius(touch.sphere) - touch.distance};
}

Gauge::Forward PackingGauge::forward(std::size_t index, const btVector3& normal) const {
  const bool of_a = index < count_a_;
  const PackingBody& own = of_a ? a_ : b_;
  const std::size_t sphere = contacts_[index].sphere;
  return {of_a, (of_a ? 1 : -1) * own.centreOf(sphere).dot(normal) + own.ownRadius(sphere)};
}

std::uint64_t PackingGauge::id(std::size_t index) const {
  return 2 * std::uint64_t(contacts_[index].sphere) + (index < count_a_ ? 0 : 1);
}

bool PackingGauge::measure(std::size_t index, const btVector3& direction, const btVector3& shift,
                           Gap& gap) const {
  const bool of_a = index < count_a_;
  const PackingBody& own = of_a ? a_ : b_;
  const PackingBody& other = of_a ? b_ : a_;
  const std::size_t sphere = contacts_[index].sphere;
  const btScalar radius = own.ownRadius(sphere);
  if (shift.length() > reachOf(index)) return false;
  const btVector3 way = of_a ? direction : -direction;
  const btVector3 from = own.centreOf(sphere) + shift;
  const btVector3 apart = other.origin() - own.origin();
  const btScalar reach = 2 * (radius + a_.slack + b_.slack);
  SurfacePoint left, entered;
  if (!leave(own, from, way, reach, of_a ? gap.triangle_a : gap.triangle_b, left) ||
      !enter(other, from - apart, way, reach, of_a ? gap.triangle_b : gap.triangle_a, entered))
    return false;
  const btVector3 offset = own.origin() - a_.origin();
  left.at += offset;
  entered.at += offset + apart;
  gap.on_a = of_a ? left.at : entered.at;
  gap.on_b = of_a ? entered.at : left.at;
  gap.normal_a = of_a ? left.normal : entered.normal;
  gap.normal_b = -(of_a ? entered.normal : left.normal);
  gap.curvature_a = of_a ? left.curvature : entered.curvature;
  gap.curvature_b = of_a ? entered.curvature : left.curvature;
  gap.triangle_a = of_a ? left.triangle : entered.triangle;
  gap.triangle_b = of_a ? entered.triangle : left.triangle;
  return true;
}

bool PackingGauge::nearest(std::size_t index, btVector3& direction) const {
  const bool of_a = index < count_a_;
  const PackingBody& own = of_a ? a_ : b_;
  const PackingBody& other = of_a ? b_ : a_;
  const std::size_t sphere = contacts_[index].sphere;
  const btMatrix3x3& axes = other.world.getBasis();
  const btVector3 centre = own.origin() + own.centreOf(sphere) - other.origin();
  const btScalar reach = 2 * (own.ownRadius(sphere) + a_.slack + b_.slack);
  NearestTriangle::Result nearest;
  if (!other.shape().nearestTriangle().find((centre * axes) / other.scale(), reach / other.scale(), nearest))
    return false;
  direction = (axes * nearest.normal) * btScalar(of_a ? -1 : 1);
  return true;
}

Gauge::Beyond PackingGauge::beyond(std::size_t index, const Gap& gap, const btVector3& towards) const {
  const btScalar step = reachOf(index);
  const auto goesOn = [&](const PackingBody& body, const btVector3& at, const btVector3& normal) {
    const btVector3 along = (towards - normal * towards.dot(normal)).normalized();
    return faceAt(body, at + along * step, normal, step);
  };
  return {goesOn(a_, gap.on_a, gap.normal_a), goesOn(b_, gap.on_b - apart(), -gap.normal_b)};
}

void PackingGauge::corners(std::size_t index, const Gap& gap, const btVector3& normal, bool of_a,
                           std::vector<Corner>& corners) const {
  const btScalar reach = reachOf(index);
  if (of_a) {
    const btVector3 face = gap.on_b - apart();
    const auto over = [&](const btVector3& at) {
      const btVector3 place = at - apart();
      return faceAt(b_, place - normal * (place - face).dot(normal), -normal, reach);
    };
    appendCorners(a_, gap.triangle_a, normal, gap.on_a, reach, kCornerId, over, corners);
  } else {
    const std::size_t first = corners.size();
    const auto over = [&](const btVector3& at) {
      const btVector3 place = at + apart();
      return faceAt(a_, place - normal * (place - gap.on_a).dot(normal), normal, reach);
    };
    appendCorners(b_, gap.triangle_b, -normal, gap.on_b - apart(), reach, kCornerId + 1, over, corners);
    for (std::size_t i = first; i < corners.size(); ++i) corners[i].at += apart();
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
