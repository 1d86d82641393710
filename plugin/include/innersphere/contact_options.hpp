// Says how overlap becomes contact: the options of a registration, of a shape and of a pair.
#pragma once

#include <cstdint>
#include <memory>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/query.hpp"
#include "innersphere/query_queue.hpp"

namespace innersphere {

/// Says how bodies in contact push each other.
enum class Response {
  /// The solver gets contact points with stiffness and damping: an implicit spring, which is stable at any
  /// stiffness and step.
  compliant,
  /// The solver gets ordinary contact points and removes the penetration.
  rigid,
  /// The force stiffness * sum V n over all overlapping spheres acts as impulses before the solver runs. It
  /// keeps the energy where damping and friction are 0. It is explicit: a stiffness that is too high for the
  /// step throws bodies apart, see PairOverlap::largest_step. Contacts are reported, with their impulses, but
  /// the solver leaves them alone. Links of a btMultiBody, which take no impulses, get compliant contacts, as
  /// deep as the spheres say.
  penalty
};

/// Says what has to be done for a pair in a step, from the least work to the most.
enum class Reuse : std::uint8_t {
  idle,       ///< The bodies stay apart: nothing is done.
  transport,  ///< The contacts are moved along with the bodies.
  refine,     ///< The depth is evaluated again at the samples that a search has found.
  search      ///< Contact is searched for.
};

/// Holds the options of a registration, which hold for every pair of the dispatcher, or of a shape: see
/// PackingShape::setContactOptions().
///
/// Friction, restitution, rolling and spinning friction are the bodies' own, as Bullet combines them. Bodies
/// that have friction, but no rolling or spinning friction, and touch in one place or along a line, resist
/// rolling as if their load lay 0.00001 sizes of the smaller one ahead (a ball of 1 m loses 0.07 mm/s of its
/// speed in a second), and spinning as the friction of a small round contact does: else balls would never
/// come to rest. What rocks where surfaces are nearly flat together, as rings on rings, is braked
/// as backward Euler does. Friction that holds is anchored, but with Response::penalty:
/// CF_HAS_FRICTION_ANCHOR changes nothing.
struct ContactOptions {
  /// How bodies push each other; Response::compliant by default.
  Response response = Response::compliant;
  /// Where overlap queries run. Backend::automatic, the default, takes a device where there is enough work
  /// for it. Backend::cuda throws Error no_device at the registration if there is none.
  Backend backend = Backend::automatic;
  /// The radii for overlap volumes, where these decide the depth of contact (see stiffness).
  Estimator estimator = Estimator::volume_true;
  /// The largest gap to the surfaces [m] that a pair may leave: it uses the fewest spheres (64, 128, 256,
  /// ...) that keep to it. For two packings the gaps of both bodies together count, for another shape that of
  /// the packing. Features that are finer are felt later, or not at all; depths are measured on the surfaces
  /// all the same. A pair never uses more spheres than PackingShape::sphereCount(). 0, the default, uses that
  /// many, and so does a packing without a surface.
  double accuracy = 0;
  /// The pressure that a metre of overlap causes [N/m^3], 0 or more: a contact pushes with stiffness times
  /// overlap volume, which the spheres alone decide. 0, the default, stands for one that depends on the size
  /// s of the smaller body, a radius about its centre of mass that holds all of it, and on the pair's reduced
  /// mass m:
  ///
  /// Response::compliant is as stiff as ten iterations of Bullet's solver bring to rest, which is 18 m / dt^2
  /// (1 + depth / (0.002 s)), divided among the points that push the same way. A body that lies still sinks
  /// by 0.15 mm at 60 Hz, whatever its mass. In a chain, where both bodies touch two others at most, and each
  /// other in one round place, it is 31 m / dt^2 (1 + depth / (0.005 s)). Depth is measured on the solids'
  /// surfaces, so bodies meet where they are drawn.
  ///
  /// Response::penalty has m / (dt^2 pi s^2), which the step dt resolves: a body at rest sinks by g dt^2 pi
  /// s^2 / A, where A is the area of the contact.
  ///
  /// Response::rigid has no stiffness.
  double stiffness = 0;
  /// The damping of a contact, 0 or more: 0 is bouncy, and with 1, the default, the spring itself has no
  /// rebound. It is the fraction of critical damping; of four times that for Response::compliant with its
  /// default stiffness. Response::rigid has none. Bullet's restitution works on top of it; with
  /// Response::penalty a restitution above 0 sets the damping in its place, if that is less.
  double damping = 1;
  /// The least work that is done for a pair in a step. With Reuse::idle, the default, contacts that were
  /// found are used again while bodies hardly move against each other. Reuse::search takes several times as
  /// long; it is for tests and measurements, and to find out where a fault lies. See ContactStatistics.
  Reuse reuse = Reuse::idle;
  /// Where pairs of packings are searched together with those of other worlds that other threads step. The
  /// motion has the same bits. Null, the default: the world has queries of its own. Backend then says
  /// nothing.
  std::shared_ptr<QueryQueue> queue;
};

inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns the options of a pair: `a` and `b` are those that its shapes have of their own, null for none, and
/// `world` those of the dispatcher.
///
/// Backend, estimator and reuse are the dispatcher's in any case, because one query serves all of its pairs.
/// The rest is the dispatcher's if neither shape has its own, and the shape's if one has. If both have:
///   - response: theirs if it is the same. Else Response::rigid counts as infinitely stiff and gives way to
///     the other, and Response::penalty gives way to Response::compliant, which is stable at any step;
///   - stiffness: that of two springs in series, 1 / (1/a + 1/b), so that two equal bodies are half as stiff
///     as one of them against a body without options. The default stiffness, 0, is as stiff as the step
///     resolves: it counts as infinitely stiff, as Response::rigid does;
///   - damping: the mean, weighted by 1/stiffness: the softer body has more say, and all of it if only one
///     has a stiffness;
///   - accuracy: the finer one; 0, which is all spheres, is the finest.
ContactOptions combine(const ContactOptions& world, const ContactOptions* a, const ContactOptions* b);

}  // namespace INNERSPHERE_BULLET_PRECISION

}  // namespace innersphere
