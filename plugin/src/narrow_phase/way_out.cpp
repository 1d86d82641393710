#include "narrow_phase/way_out.hpp"

#include <algorithm>

#include "narrow_phase/surface_rays.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Lines of a way, at most. They are few, as all ways need them while the bodies are that deep.
constexpr std::size_t kLines = 32;

struct WayOut {
  btVector3 direction;  ///< unit, from A to B: A leaves against it
  btScalar length = BT_LARGE_FLOAT;
  std::vector<WeightedPoint> points;
};

class WaysOut {
 public:
  WaysOut(const PlacedPacking& a, const PlacedPacking& b, const std::vector<SphereContact>& contacts,
          const ContactSpheres& spheres)
      : a_(a), b_(b), contacts_(contacts), spheres_(spheres), apart_(b.origin() - a.origin()) {}

  void tryAll() {
    btVector3 gradient(0, 0, 0), middle(0, 0, 0);
    btScalar volume = 0;
    for (const SphereContact& contact : contacts_) {
      gradient += toBullet(contact.area);
      middle += toBullet(contact.centroid) * contact.volume;
      volume += contact.volume;
    }
    tryAlong(gradient);
    tryAlong(apart_);
    if (volume > 0) {
      middle /= volume;
      SurfaceQueries::Nearest nearest;
      if (a_.nearest(middle, BT_LARGE_FLOAT, nearest)) tryAlong(nearest.normal);
      if (b_.nearest(middle - apart_, BT_LARGE_FLOAT, nearest)) tryAlong(-nearest.normal);
    }
    for (const PlacedPacking* body : {&a_, &b_}) {
      for (int axis = 0; axis < 3; ++axis) {
        tryAlong(body->world.getBasis().getColumn(axis));
        tryAlong(-body->world.getBasis().getColumn(axis));
      }
    }
  }
  const WayOut& shortest() const { return shortest_; }

 private:
  void tryAlong(const btVector3& way) {
    if (way.fuzzyZero()) return;
    WayOut tried{way.normalized(), 0, {}};
    const std::size_t step = (contacts_.size() + kLines - 1) / kLines;
    for (std::size_t i = 0; i < contacts_.size() && tried.length < shortest_.length; i += step)
      addLine(i, tried);
    if (!tried.points.empty() && tried.length < shortest_.length) shortest_ = std::move(tried);
  }

  void addLine(std::size_t i, WayOut& way) const {
    const btVector3 from = toBullet(contacts_[i].centroid);
    SurfacePoint left, entered;
    if (!leaveSolid(a_, from, way.direction, BT_LARGE_FLOAT, OpposedPoints::kNone, left) ||
        !leaveSolid(b_, from - apart_, -way.direction, BT_LARGE_FLOAT, OpposedPoints::kNone, entered))
      return;
    WeightedPoint point{};
    point.kind = WeightedPoint::Kind::faces;
    point.point.on_b = entered.at + apart_;
    point.point.normal = way.direction;
    point.point.depth = (left.at - point.point.on_b).dot(way.direction);
    point.point.id = spheres_.id(i);
    way.length = btMax(way.length, point.point.depth);
    way.points.push_back(point);
  }

  const PlacedPacking& a_;
  const PlacedPacking& b_;
  const std::vector<SphereContact>& contacts_;
  const ContactSpheres& spheres_;
  const btVector3 apart_;
  WayOut shortest_;
};

/// Gives each point an equal share of a patch that is as large as the overlap's volume over its depth.
void shareOutArea(const std::vector<SphereContact>& contacts, btScalar depth,
                  std::vector<WeightedPoint>& points) {
  btScalar volume = 0;
  for (const SphereContact& contact : contacts) volume += contact.volume;
  btVector3 centre(0, 0, 0);
  for (const WeightedPoint& p : points) centre += p.point.on_b / btScalar(points.size());
  btScalar radius = 0;
  for (const WeightedPoint& p : points) radius += p.point.on_b.distance(centre) / btScalar(points.size());
  for (WeightedPoint& p : points) {
    p.area = volume / depth / btScalar(points.size());
    p.centre = centre;
    p.radius = radius;
  }
}

}  // namespace

void findWayOut(const PlacedPacking& a, const PlacedPacking& b, const std::vector<SphereContact>& contacts,
                const ContactSpheres& spheres, std::vector<WeightedPoint>& found) {
  found.clear();
  WaysOut ways(a, b, contacts, spheres);
  ways.tryAll();
  if (!(ways.shortest().length > 0) || ways.shortest().points.empty()) return;
  found = ways.shortest().points;
  shareOutArea(contacts, ways.shortest().length, found);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
