#include "narrow_phase/surface_probe.hpp"

#include <algorithm>

#include "narrow_phase/edge_edge.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A surface that is met at a flatter angle than 30 degrees is the side of the solid, not the face in
/// contact.
constexpr btScalar kFacing = btScalar(0.5);
/// Normals within 5 degrees are those of one flat face, within 15 degrees of one that bends: a corner may be
/// over it some way from where it was measured. A place this deep, in spheres, is under it.
constexpr btScalar kSameFace = btScalar(0.996);
constexpr btScalar kSameBentFace = btScalar(0.966);
constexpr btScalar kSunk = btScalar(0.1);
constexpr std::uint64_t kCornerId = std::uint64_t(1) << 62;

/// A point of a body's surface, relative to the body's origin, axes of the world.
struct SurfacePoint {
  btVector3 at{0, 0, 0};
  btVector3 normal{0, 0, 0};  ///< unit, out of the solid
  btScalar facing = 0;        ///< cosine between the triangle's normal and the ray
  btScalar curvature = 0;     ///< [1/m]
  std::size_t triangle = OpposedPoints::kNone;
};

/// In the frame of a surface.
struct Ray {
  Ray(const PlacedPacking& body, const btVector3& start, const btVector3& way, btScalar length)
      : from((start * body.world.getBasis()) / body.scale()),
        direction(way * body.world.getBasis()),
        reach(length / body.scale()) {}
  btVector3 from;
  btVector3 direction;
  btScalar reach;
};

SurfacePoint pointOf(const PlacedPacking& body, const SurfaceQueries::Hit& hit, const btVector3& from,
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

/// Where a ray from inside the solid leaves it; through triangle `known` or one near it, if it does.
bool leave(const PlacedPacking& body, const btVector3& from, const btVector3& direction, btScalar reach,
           std::size_t known, SurfacePoint& point) {
  const SurfaceQueries& tree = body.shape().surfaceQueries();
  const Ray ray(body, from, direction, reach);
  SurfaceQueries::Hit hit;
  const auto leaves = [&] {
    point = pointOf(body, hit, from, direction);
    return !(point.facing < kFacing);
  };
  const bool near = known != OpposedPoints::kNone &&
                    tree.castNear(known, ray.from, ray.direction, ray.reach, hit) && hit.distance > 0 &&
                    leaves();
  if (!near && !(tree.cast(ray.from, ray.direction, ray.reach, ray.direction, hit) && leaves())) return false;
  point.at += direction * body.margin;
  return true;
}

/// Where the line of a ray enters the solid: ahead of it, or behind if it starts inside; through triangle
/// `known` or one near it, if it does.
bool enter(const PlacedPacking& body, const btVector3& from, const btVector3& direction, btScalar reach,
           std::size_t known, const btVector3& opposed, SurfacePoint& point) {
  const SurfaceQueries& tree = body.shape().surfaceQueries();
  const Ray ray(body, from, direction, reach);
  const btVector3 towards = -opposed * body.world.getBasis();
  SurfaceQueries::Hit hit;
  const auto enters = [&] {
    point = pointOf(body, hit, from, direction);
    return !(point.facing > -kFacing);
  };
  const bool near = known != OpposedPoints::kNone &&
                    tree.castNear(known, ray.from, ray.direction, ray.reach, hit) && enters();
  if (!near) {
    if (!tree.cast(ray.from, ray.direction, ray.reach, towards, hit)) return false;
    point = pointOf(body, hit, from, direction);
    if (point.facing > 0) {
      // A line along a face may miss the edge where it enters.
      SurfaceQueries::Nearest nearest;
      const bool inside = tree.nearest(ray.from, ray.reach, nearest) && nearest.distance < 0;
      if (!inside || !tree.cast(ray.from, -ray.direction, ray.reach, towards, hit)) return false;
      point = pointOf(body, hit, from, -direction);
      point.facing = -point.facing;
    }
  }
  if (point.facing > -kFacing) return false;
  point.at -= direction * body.margin;
  return true;
}

/// Whether a face with this normal is at a place. `size` is that of the things looked at.
bool faceAt(const PlacedPacking& body, const btVector3& at, const btVector3& normal, btScalar size) {
  // A little inside, where the direction to the face is well defined.
  const btVector3 place = at - normal * (kSunk * size + body.margin);
  SurfaceQueries::Nearest nearest;
  return body.nearest(place, size, nearest) && nearest.distance < 0 &&
         nearest.normal.dot(normal) > kSameBentFace;
}

/// The face with about this normal that a place is over or under, if there is one.
bool faceUnder(const PlacedPacking& body, const btVector3& at, const btVector3& normal, btScalar size,
               SurfacePoint& point) {
  const btVector3 inside = at - normal * (kSunk * size + body.margin);
  return faceAt(body, at, normal, size) && leave(body, inside, normal, size, OpposedPoints::kNone, point);
}

/// Corners uphill from a triangle, relative to the body's origin: visit(corner, id, is_peak).
template <typename Visit>
void forEachCorner(const PlacedPacking& body, std::size_t triangle, const btVector3& direction,
                   const btVector3& start, btScalar reach, std::uint64_t first_id, const Visit& visit) {
  static thread_local std::vector<std::uint32_t> vertices;
  const btMatrix3x3& axes = body.world.getBasis();
  vertices.clear();
  const bool is_peak = body.shape().vertexHillClimb().from(
      triangle, direction * axes, (start * axes) / body.scale(), reach / body.scale(), vertices);
  for (std::uint32_t v : vertices) {
    const btVector3 vertex = axes * (toBullet(body.shape().packing().surface.vertices[v]) * body.scale());
    visit(vertex + direction * body.margin, first_id + 2 * std::uint64_t(v), is_peak);
  }
}

}  // namespace

bool ShapeProbe::goesOn(const NearSphere& near_sphere, const btVector3& place) const {
  // A little above a face it is that far away; beyond its edge it is further.
  constexpr btScalar kAbove = btScalar(0.03), kFurther = btScalar(0.01);  // of the sphere's reach
  const btScalar reach = a_.reach(near_sphere.sphere);
  const btVector3 above = place + near_sphere.normal * (kAbove * reach);
  // On a large ground.
  const btScalar rounding = 4 * SIMD_EPSILON * (a_.origin() + above - world_.getOrigin()).length();
  btScalar distance = 0;
  return !other_.distanceOf(a_, world_, above, distance) || distance < (kAbove + kFurther) * reach + rounding;
}

bool ShapeProbe::measure(std::size_t index, const btVector3&, const btVector3& shift,
                         OpposedPoints& gap) const {
  const NearSphere& near_sphere = near_spheres_[index];
  const btScalar radius = a_.ownRadius(near_sphere.sphere);
  // Only of a flat surface it is known what it is like beside the nearest point.
  const bool flat = near_sphere.curvature == 0 && !near_sphere.isOnEdge();
  if (shift.length2() > 0 && (!flat || shift.length() > radius + a_.search_margin)) return false;
  const btVector3 from = a_.centreOf(near_sphere.sphere) + near_sphere.aside + shift;
  const btVector3 towards_b = -near_sphere.normal;
  gap.on_b = from + towards_b * near_sphere.distance;
  if (shift.length2() > 0 && !goesOn(near_sphere, gap.on_b)) return false;
  SurfacePoint on_a;
  const bool leaves = leave(a_, from, towards_b, 2 * (radius + a_.search_margin), gap.triangle_a, on_a);
  if (on_a.triangle == OpposedPoints::kNone && gap.triangle_a != OpposedPoints::kNone) {
    // Deep in A: it is some other face that is near.
    const SharpEdges a(a_, {0, 0, 0});
    on_a.triangle = gap.triangle_a;
    on_a.at = a.middle(gap.triangle_a);
    on_a.normal = a.face(gap.triangle_a);
    on_a.curvature = a.surface->normals().curvature(gap.triangle_a) / a.scale;
  }
  gap.on_a = on_a.at;
  gap.normal_a = on_a.normal;
  gap.curvature_a = on_a.curvature;
  gap.triangle_a = on_a.triangle;
  gap.normal_b = towards_b;
  gap.curvature_b = near_sphere.curvature;
  return leaves;
}

bool ShapeProbe::nearest(std::size_t index, btVector3& direction, OpposedPoints& gap) const {
  gap.triangle_a = a_.shape().solid->triangleNear(near_spheres_[index].sphere);
  direction = -near_spheres_[index].normal;
  return true;
}

void ShapeProbe::corners(std::size_t index, const OpposedPoints& gap, const btVector3& normal, bool of_a,
                         std::vector<Corner>& corners) const {
  if (!of_a) return;
  const auto reachOf = [&](const NearSphere& near_sphere) {
    return a_.ownRadius(near_sphere.sphere) + a_.search_margin;
  };
  forEachCorner(a_, gap.triangle_a, normal, gap.on_a, reachOf(near_spheres_[index]), kCornerId,
                [&](const btVector3& at, std::uint64_t id, bool is_peak) {
                  // The face is known where spheres are near it.
                  Corner corner{gap, id, is_peak};
                  const NearSphere* over = nullptr;
                  btScalar nearest = BT_LARGE_FLOAT;
                  for (const NearSphere& near_sphere : near_spheres_) {
                    const btScalar reach = reachOf(near_sphere);
                    const btVector3 centre = a_.centreOf(near_sphere.sphere);
                    const btScalar distance2 = centre.distance2(at);
                    if (near_sphere.isOnEdge() || !(distance2 < reach * reach)) continue;
                    if (!(near_sphere.normal.dot(-normal) > kSameFace)) continue;
                    if (!(distance2 < nearest)) continue;
                    nearest = distance2;
                    over = &near_sphere;
                    corner.gap.normal_b = -near_sphere.normal;
                    const btScalar height = (at - centre).dot(near_sphere.normal) + near_sphere.distance;
                    corner.gap.on_b = at - near_sphere.normal * height;
                  }
                  corner.gap.on_a = at;
                  if (over != nullptr && goesOn(*over, corner.gap.on_b)) corners.push_back(corner);
                });
}

bool ShapeProbe::crossing(const OpposedPoints& gap, const btVector3& direction, Corner& crossing) const {
  SharpEdges b;
  OpposedPoints start = gap;
  // Seen from outside.
  const btVector3 place = gap.on_b - gap.normal_b * a_.search_margin;
  if (!other_.facets(a_, world_, b) || !b.nearestTriangle(place, start.triangle_b)) return false;
  crossing.is_alone = btFabs(b.face(start.triangle_b).dot(gap.normal_b)) < kSameFace;
  return crossingEdges({a_, {0, 0, 0}}, b, start, direction, crossing);
}

SurfaceProbe::Forward ShapeProbe::forward(std::size_t index, const btVector3&) const {
  const NearSphere& near_sphere = near_spheres_[index];
  return {true, a_.ownRadius(near_sphere.sphere) - near_sphere.distance};
}

SurfaceProbe::Forward PackingProbe::forward(std::size_t index, const btVector3& normal) const {
  const bool of_a = index < count_a_;
  const PlacedPacking& own = of_a ? a_ : b_;
  const std::size_t sphere = contacts_[index].sphere;
  return {of_a, (of_a ? 1 : -1) * own.centreOf(sphere).dot(normal) + own.ownRadius(sphere)};
}

std::uint64_t PackingProbe::id(std::size_t index) const {
  return 2 * std::uint64_t(contacts_[index].sphere) + (index < count_a_ ? 0 : 1);
}

bool PackingProbe::measure(std::size_t index, const btVector3& direction, const btVector3& shift,
                           OpposedPoints& gap) const {
  const bool of_a = index < count_a_;
  const PlacedPacking& own = of_a ? a_ : b_;
  const PlacedPacking& other = of_a ? b_ : a_;
  const std::size_t sphere = contacts_[index].sphere;
  const btScalar radius = own.ownRadius(sphere);
  if (shift.length() > reachOf(index)) return false;
  const btVector3 way = of_a ? direction : -direction;
  const btVector3 from = own.centreOf(sphere) + shift;
  const btVector3 apart = other.origin() - own.origin();
  const btScalar reach = 2 * (radius + a_.search_margin + b_.search_margin);
  SurfacePoint left, entered;
  if (!leave(own, from, way, reach, of_a ? gap.triangle_a : gap.triangle_b, left) ||
      !enter(other, from - apart, way, reach, of_a ? gap.triangle_b : gap.triangle_a, left.normal, entered))
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

bool PackingProbe::nearest(std::size_t index, btVector3& direction, OpposedPoints& gap) const {
  const bool of_a = index < count_a_;
  const PlacedPacking& own = of_a ? a_ : b_;
  const PlacedPacking& other = of_a ? b_ : a_;
  const std::size_t sphere = contacts_[index].sphere;
  const btVector3 centre = own.origin() + own.centreOf(sphere) - other.origin();
  const btScalar reach = 2 * (own.ownRadius(sphere) + a_.search_margin + b_.search_margin);
  (of_a ? gap.triangle_a : gap.triangle_b) = own.shape().solid->triangleNear(sphere);
  SurfaceQueries::Nearest nearest;
  if (!other.nearest(centre, reach, nearest)) return false;
  if (!nearest.beside) (of_a ? gap.triangle_b : gap.triangle_a) = nearest.triangle;
  direction = nearest.normal * btScalar(of_a ? -1 : 1);
  return true;
}

SurfaceProbe::Reach PackingProbe::reach(const OpposedPoints& gap, const btVector3& towards) const {
  const auto until = [&](const PlacedPacking& body, std::size_t triangle, const btVector3& at) {
    const btMatrix3x3& axes = body.world.getBasis();
    return body.scale() *
           body.shape().surfaceQueries().untilSharpEdge(triangle, (at * axes) / body.scale(), towards * axes);
  };
  return {until(a_, gap.triangle_a, gap.on_a), until(b_, gap.triangle_b, gap.on_b - apart())};
}

bool PackingProbe::crossing(const OpposedPoints& gap, const btVector3& direction, Corner& crossing) const {
  return crossingEdges({a_, {0, 0, 0}}, {b_, apart()}, gap, direction, crossing);
}

void PackingProbe::corners(std::size_t index, const OpposedPoints& gap, const btVector3& normal, bool of_a,
                           std::vector<Corner>& corners) const {
  const btScalar reach = reachOf(index);
  const PlacedPacking& own = of_a ? a_ : b_;
  const PlacedPacking& other = of_a ? b_ : a_;
  // All of this relative to the solid whose corners are looked for; `way` leads out of it.
  const btVector3 offset = of_a ? btVector3(0, 0, 0) : apart();
  const btVector3 to_other = of_a ? apart() : -apart();
  const btVector3 way = of_a ? normal : -normal;
  const btVector3 face = (of_a ? gap.on_b : gap.on_a) - offset;
  forEachCorner(own, of_a ? gap.triangle_a : gap.triangle_b, way, (of_a ? gap.on_a : gap.on_b) - offset,
                reach, kCornerId + (of_a ? 0 : 1), [&](const btVector3& at, std::uint64_t id, bool is_peak) {
                  SurfacePoint under;
                  const btVector3 place = at - way * (at - face).dot(way) - to_other;
                  if (!faceUnder(other, place, -way, reach, under)) return;
                  Corner corner{gap, id, is_peak};
                  (of_a ? corner.gap.on_a : corner.gap.on_b) = at + offset;
                  (of_a ? corner.gap.on_b : corner.gap.on_a) = under.at + to_other + offset;
                  (of_a ? corner.gap.normal_b : corner.gap.normal_a) = under.normal * btScalar(of_a ? -1 : 1);
                  corners.push_back(corner);
                });
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
