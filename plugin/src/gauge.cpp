#include "gauge.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A surface that is met at a flatter angle than 30 degrees is the side of the solid, not the face in
/// contact.
constexpr btScalar kFacing = btScalar(0.5);
/// A ray that starts inside a sphere by this fraction of its radius starts inside the solid.
constexpr btScalar kInside = btScalar(0.95);

/// A point of a body's surface, relative to the body's origin, axes of the world.
struct SurfacePoint {
  btVector3 at{0, 0, 0};
  btVector3 normal{0, 0, 0};  ///< unit, out of the solid
  btScalar facing = 0;        ///< cosine between the triangle's normal and the ray
  btScalar curvature = 0;     ///< [1/m]
  btScalar faceting = 0;      ///< angle between both normals [rad]
};

bool cast(const PackingBody& body, const btVector3& from, const btVector3& direction, btScalar reach,
          SurfacePoint& point) {
  const btMatrix3x3& axes = body.world.getBasis();
  SurfaceTree::Hit hit;
  if (!body.shape().surfaceTree().cast((from * axes) / body.scale(), direction * axes, reach / body.scale(),
                                       hit)) {
    return false;
  }
  point.normal = axes * hit.normal;
  point.curvature = hit.curvature / body.scale();
  point.facing = (axes * hit.face).dot(direction);
  point.faceting = hit.face.distance(hit.normal);
  point.at = from + direction * (hit.distance * body.scale());
  return true;
}

/// Where a ray from inside the solid leaves it.
bool leave(const PackingBody& body, const btVector3& from, const btVector3& direction, btScalar reach,
           SurfacePoint& point) {
  if (!cast(body, from, direction, reach, point) || point.facing < kFacing) return false;
  point.at += direction * body.margin;
  return true;
}

/// Where the line of a ray enters the solid: ahead of it, or behind if it starts inside.
bool enter(const PackingBody& body, const btVector3& from, const btVector3& direction, btScalar reach,
           SurfacePoint& point) {
  if (!cast(body, from, direction, reach, point)) return false;
  if (point.facing > 0 && !cast(body, from, -direction, reach, point)) return false;
  if (btFabs(point.facing) < kFacing) return false;
  point.at -= direction * body.margin;
  return true;
}

}  // namespace

bool SurfaceGauge::measure(std::size_t index, const btVector3&, const btVector3& shift, Gap& gap) const {
  if (shift.length2() > 0) return false;
  const Touch& touch = touches_[index];
  const btVector3 centre = a_.centreOf(touch.sphere);
  const btVector3 towards_b = -touch.normal;
  const btScalar reach = 2 * (a_.ownRadius(touch.sphere) + a_.slack);
  SurfacePoint on_a;
  if (!leave(a_, centre, towards_b, reach, on_a)) return false;
  gap.on_a = on_a.at;
  gap.normal_a = on_a.normal;
  gap.curvature_a = on_a.curvature;
  gap.on_b = centre + towards_b * touch.distance;
  gap.normal_b = towards_b;
  gap.curvature_b = touch.curvature;
  return true;
}

bool SurfaceGauge::nearest(std::size_t index, btVector3& direction) const {
  direction = -touches_[index].normal;
  return true;
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
  if (shift.length() > kInside * radius) return false;
  const btVector3 way = of_a ? direction : -direction;
  const btVector3 from = own.centreOf(sphere) + shift;
  const btVector3 apart = other.origin() - own.origin();
  const btScalar reach = 2 * (radius + a_.slack + b_.slack);
  SurfacePoint left, entered;
  if (!leave(own, from, way, reach, left) || !enter(other, from - apart, way, reach, entered)) return false;
  const btVector3 offset = own.origin() - a_.origin();
  left.at += offset;
  entered.at += offset + apart;
  gap.on_a = of_a ? left.at : entered.at;
  gap.on_b = of_a ? entered.at : left.at;
  gap.normal_a = of_a ? left.normal : entered.normal;
  gap.normal_b = -(of_a ? entered.normal : left.normal);
  gap.curvature_a = of_a ? left.curvature : entered.curvature;
  gap.curvature_b = of_a ? entered.curvature : left.curvature;
  gap.faceting = left.faceting + entered.faceting;
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

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
