#include "narrow_phase/way_out.hpp"

#include <algorithm>
#include <utility>

#include "narrow_phase/hill.hpp"
#include "narrow_phase/surface_rays.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Lines of a way, at most. They are few, as all ways need them while the bodies are that deep.
constexpr std::size_t kLines = 32;
/// Spheres of each body that are looked at, at most, beside all balls where there is none.
constexpr std::size_t kSpheres = 512;
/// A way that bodies are on is at most as long as this in the next search, or something is in it. The slowest
/// do half of their size in a second.
constexpr btScalar kShrinks = btScalar(0.999);

struct WayOut {
  btVector3 direction;  ///< unit, from A to B: A leaves against it
  btScalar length = BT_LARGE_FLOAT;
  std::vector<WeightedPoint> points;
};

/// Says how far A goes until its spheres are clear of B's, also of those that it meets on the way: walls that
/// cross leave each other soon, and meet the next ones.
class SpheresOnTheWay {
 public:
  SpheresOnTheWay(const PlacedPacking& a, const PlacedPacking& b, const btVector3& apart)
      : a_(ballsOf(a, btVector3(0, 0, 0))), b_(ballsOf(b, apart)) {
    for (const Ball& ball : b_) largest_of_b_ = btMax(largest_of_b_, ball.radius);
  }

  btScalar length(const btVector3& direction) const {
    static thread_local std::vector<Ball> a, b;
    static thread_local std::vector<std::pair<btScalar, btScalar>> met;
    const Across across(direction);
    project(a_, direction, across, a);
    project(b_, direction, across, b);
    met.clear();
    const auto isLeft = [](const Ball& p, const Ball& q) { return p.centre.x() < q.centre.x(); };
    std::sort(b.begin(), b.end(), isLeft);
    for (const Ball& p : a) {
      const btScalar reach = p.radius + largest_of_b_;
      const auto first = std::lower_bound(b.begin(), b.end(), p.centre.x() - reach,
                                          [](const Ball& q, btScalar x) { return q.centre.x() < x; });
      for (auto q = first; q != b.end() && q->centre.x() < p.centre.x() + reach; ++q) {
        const btVector3 way = p.centre - q->centre;
        const btScalar radius = p.radius + q->radius;
        const btScalar half2 = radius * radius - way.x() * way.x() - way.y() * way.y();
        if (!(half2 > 0)) continue;
        const btScalar half = btSqrt(half2);
        if (way.z() + half > 0) met.emplace_back(way.z() - half, way.z() + half);
      }
    }
    std::sort(met.begin(), met.end());
    btScalar gone = 0;
    for (const auto& [first, last] : met) {
      if (first > gone) break;
      gone = btMax(gone, last);
    }
    return gone;
  }

 private:
  struct Ball {
    btVector3 centre;
    btScalar radius;
  };

  static std::vector<Ball> ballsOf(const PlacedPacking& body, const btVector3& origin) {
    std::vector<Ball> balls;
    const auto add = [&](std::size_t i) {
      balls.push_back({origin + body.centreOf(i), body.ownRadius(i) + body.margin});
    };
    for (std::size_t i = 0; i < std::min(body.count(), kSpheres); ++i) add(i);
    for (std::size_t i = 0; body.feelers != nullptr && i < body.feelers->balls.size(); ++i)
      add(body.count() + i);
    return balls;
  }

  static void project(const std::vector<Ball>& balls, const btVector3& direction, const Across& across,
                      std::vector<Ball>& projected) {
    projected.clear();
    for (const Ball& ball : balls) {
      const btVector3& c = ball.centre;
      projected.push_back({{c.dot(across.x), c.dot(across.y), c.dot(direction)}, ball.radius});
    }
  }

  std::vector<Ball> a_, b_;
  btScalar largest_of_b_ = 0;
};

class WaysOut {
 public:
  explicit WaysOut(const OverlappingPackings& packings)
      : a_(packings.a),
        b_(packings.b),
        contacts_(packings.contacts),
        spheres_(packings.spheres),
        apart_(b_.origin() - a_.origin()),
        on_the_way_(a_, b_, apart_) {}

  void tryAll(const std::vector<ContactPatch>& patches, const btVector3& before) {
    tryAlong(before);
    if (shortest_.length < kShrinks * before.length()) return;
    btVector3 gradient(0, 0, 0), middle(0, 0, 0);
    btScalar volume = 0;
    for (const SphereContact& contact : contacts_) {
      gradient += toBullet(contact.area);
      middle += toBullet(contact.centroid) * contact.volume;
      volume += contact.volume;
    }
    for (const ContactPatch& patch : patches) tryAlong(patch.normal);
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
    if (!tried.points.empty() && tried.length < shortest_.length)
      goOn(tried, on_the_way_.length(tried.direction));
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

  static void goOn(WayOut& way, btScalar length) {
    if (!(length > way.length)) return;
    for (WeightedPoint& p : way.points) p.point.depth = length;
    way.length = length;
  }

  const PlacedPacking& a_;
  const PlacedPacking& b_;
  const std::vector<SphereContact>& contacts_;
  const ContactSpheres& spheres_;
  const btVector3 apart_;
  const SpheresOnTheWay on_the_way_;
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

void findWayOut(const OverlappingPackings& packings, const std::vector<ContactPatch>& patches,
                const btVector3& before, std::vector<WeightedPoint>& found) {
  found.clear();
  WaysOut ways(packings);
  ways.tryAll(patches, before);
  if (!(ways.shortest().length > 0) || ways.shortest().points.empty()) return;
  found = ways.shortest().points;
  shareOutArea(packings.contacts, ways.shortest().length, found);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
