#include "gauge.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A surface that is met at a flatter angle than this is the side of the solid, not the face in contact.
constexpr btScalar kFacing = btScalar(0.2);

/// Where the line through `p` along `direction` leaves the solid near sphere i. Both points relative to the
/// body's origin.
bool leave(const PackingBody& body, std::size_t i, const btVector3& p, const btVector3& direction,
           btVector3& point, btVector3& normal) {
  const btMatrix3x3& axes = body.world.getBasis();
  const btVector3 c = body.centreOf(i);
  const btScalar radius = body.ownRadius(i);
  // Start on the line, beside the centre and inside the sphere.
  btVector3 beside = p - c;
  beside -= direction * direction.dot(beside);
  const btScalar length = beside.length();
  const btScalar most = btScalar(0.95) * radius;
  if (length > most) beside *= most / length;
  const btVector3 start = c + beside;

  SurfaceTree::Hit hit;
  const btScalar reach = 2 * (radius + body.slack);
  if (!body.shape().surfaceTree().cast((start * axes) / body.scale(), direction * axes, reach / body.scale(),
                                       hit)) {
    return false;
  }
  if ((axes * hit.face).dot(direction) < kFacing) return false;
  normal = axes * hit.normal;
  point = start + direction * (hit.distance * body.scale() + body.margin);
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

/// The sphere of one side that contains the point, or comes nearest to it.
std::size_t PackingGauge::sphereAt(const Side& side, const btVector3& p) const {
  std::size_t best = contacts_[side.first].sphere;
  btScalar nearest = BT_LARGE_FLOAT;
  for (std::size_t k = side.first; k < side.last; ++k) {
    const std::size_t i = contacts_[k].sphere;
    const btScalar distance = (side.body->centreOf(i) + side.offset).distance(p) - side.body->ownRadius(i);
    if (distance < nearest) {
      nearest = distance;
      best = i;
    }
  }
  return best;
}

bool PackingGauge::measure(std::size_t index, const btVector3& direction, Gap& gap) const {
  const btVector3 p = toBullet(contacts_[index].centroid);
  const std::size_t own = contacts_[index].sphere;
  const bool of_a = index < a_.last;
  const std::size_t i = of_a ? own : sphereAt(a_, p);
  const std::size_t j = of_a ? sphereAt(b_, p) : own;
  if (!leave(*a_.body, i, p - a_.offset, direction, gap.on_a, gap.normal_a)) return false;
  if (!leave(*b_.body, j, p - b_.offset, -direction, gap.on_b, gap.normal_b)) return false;
  gap.on_b += b_.offset;
  gap.normal_b = -gap.normal_b;
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
