#include "gauge.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A surface that is met at a flatter angle than this is the side of the solid, not the face in contact.
constexpr btScalar kFacing = btScalar(0.2);
/// A ray that starts inside a sphere by this fraction of its radius starts inside the solid.
constexpr btScalar kInside = btScalar(0.95);

/// Where the line through `p` along `direction` leaves the solid near sphere i. Both points relative to the
/// body's origin.
bool leave(const PackingBody& body, std::size_t i, const btVector3& p, const btVector3& direction,
           btVector3& point, btVector3& normal) {
  const btMatrix3x3& axes = body.world.getBasis();
  const btVector3 c = body.centreOf(i);
  const btScalar radius = body.ownRadius(i);
  // Start on the line, beside the centre and inside the sphere, or as near to the line as that goes.
  btVector3 beside = p - c;
  beside -= direction * direction.dot(beside);
  const btScalar length = beside.length();
  const btScalar most = kInside * radius;
  if (length > most) beside *= most / length;
  const btVector3 start = c + beside;

  SurfaceTree::Hit hit;
  const btScalar reach = 2 * (radius + body.slack);
  if (!body.shape().surfaceTree().cast((start * axes) / body.scale(), direction * axes, reach / body.scale(),
                                       hit)) {
    return false;
  }
  const btVector3 face = axes * hit.face;
  if (face.dot(direction) < kFacing) return false;
  normal = axes * hit.normal;
  // The face, continued to the line.
  const btVector3 met = start + direction * (hit.distance * body.scale() + body.margin);
  point = p + direction * ((met - p).dot(face) / direction.dot(face));
  return true;
}

}  // namespace

bool SurfaceGauge::measure(std::size_t index, const btVector3&, Gap& gap) const {
  const Touch& touch = touches_[index];
  const btVector3 centre = a_.centreOf(touch.sphere);
  const btVector3 towards_b = -touch.normal;
  if (!leave(a_, touch.sphere, centre, towards_b, gap.on_a, gap.normal_a)) return false;
  gap.on_b = centre + towards_b * touch.distance;
  gap.normal_b = towards_b;
  return true;
}

PackingGauge::PackingGauge(const PackingBody& a, const PackingBody& b,
                           const std::vector<SphereContact>& contacts, std::size_t count_a)
    : contacts_(contacts),
      a_{&a, btVector3(0, 0, 0), 0, count_a},
      b_{&b, b.origin() - a.origin(), count_a, contacts.size()} {}

std::uint64_t PackingGauge::id(std::size_t index) const {
  return 2 * std::uint64_t(contacts_[index].sphere) + (index < a_.last ? 0 : 1);
}

/// The sphere of one side that the line through `p` passes through nearest to p, or passes most closely.
std::size_t PackingGauge::sphereOn(const Side& side, const btVector3& p, const btVector3& direction) const {
  std::size_t best = contacts_[side.first].sphere;
  btScalar least = BT_LARGE_FLOAT;
  for (std::size_t k = side.first; k < side.last; ++k) {
    const std::size_t i = contacts_[k].sphere;
    const btVector3 apart = side.body->centreOf(i) + side.offset - p;
    const btScalar along = apart.dot(direction);
    const btScalar beside = (apart - direction * along).length() - kInside * side.body->ownRadius(i);
    const btScalar cost = btMax(btScalar(0), beside) + btScalar(0.1) * btFabs(along);
    if (cost < least) {
      least = cost;
      best = i;
    }
  }
  return best;
}

bool PackingGauge::measure(std::size_t index, const btVector3& direction, Gap& gap) const {
  const std::size_t own = contacts_[index].sphere;
  const bool of_a = index < a_.last;
  const Side& side = of_a ? a_ : b_;
  const btVector3 p = side.body->centreOf(own) + side.offset;
  const std::size_t partner = sphereOn(of_a ? b_ : a_, p, direction);
  return measure(of_a ? own : partner, of_a ? partner : own, p, direction, gap);
}

bool PackingGauge::measureAt(const btVector3& p, const btVector3& direction, Gap& gap) const {
  return measure(sphereOn(a_, p, direction), sphereOn(b_, p, direction), p, direction, gap);
}

bool PackingGauge::measure(std::size_t i, std::size_t j, const btVector3& p, const btVector3& direction,
                           Gap& gap) const {
  if (!leave(*a_.body, i, p - a_.offset, direction, gap.on_a, gap.normal_a)) return false;
  if (!leave(*b_.body, j, p - b_.offset, -direction, gap.on_b, gap.normal_b)) return false;
  gap.on_b += b_.offset;
  gap.normal_b = -gap.normal_b;
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
