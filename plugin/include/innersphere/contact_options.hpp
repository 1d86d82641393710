// How overlap becomes contact.
#pragma once

#include <cstdint>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/query.hpp"

namespace innersphere {

/// What Bullet's solver is given.
enum class Response {
  compliant,  ///< contact points with stiffness and damping: an implicit spring, stable at any stiffness and
              ///< step
  rigid,      ///< ordinary contact points: the solver removes the penetration
  /// The force stiffness * sum V n over all overlapping spheres, as impulses before the solver runs: keeps
  /// the energy where damping and friction are 0. Explicit: a stiffness that is too high for the step throws
  /// bodies apart, see PairOverlap::largest_step. Contacts are reported, with their impulses, but the solver
  /// leaves them alone. Links of a btMultiBody, which take no impulses, get compliant contacts, as deep as
  /// the spheres say.
  penalty
};

/// What has to be done for a pair in a step, from the least work to the most.
enum class Reuse : std::uint8_t {
  idle,       ///< The bodies stay apart: nothing is done.
  transport,  ///< The contacts are moved along with the bodies.
  refine,     ///< The depth is evaluated again at the samples that a search has found.
  search      ///< Contact is searched for.
};

/// Options of a registration, which hold for every pair of the dispatcher, or of a shape: see
/// PackingShape::setContactOptions().
///
/// Friction, restitution, rolling and spinning friction are the bodies' own, as Bullet combines them. Bodies
/// that have friction, but no rolling or spinning friction, and touch in one place or along a line, resist
/// rolling as if their load lay 0.00001 sizes of the smaller one ahead (a ball of 1 m loses 0.07 mm/s of its
/// speed in a second), and spinning as the friction of a small round contact does: else balls would never
/// come to rest. Friction that holds is anchored, but with Response::penalty: CF_HAS_FRICTION_ANCHOR changes
/// nothing.
struct ContactOptions {
  Response response = Response::compliant;  ///< what Bullet's solver is given
  Backend backend = Backend::automatic;     ///< where overlap queries run
  /// Radii for overlap volumes, where these decide the depth of contact (see stiffness).
  Estimator estimator = Estimator::volume_true;
  /// [m] Each pair uses the fewest spheres (64, 128, 256, ...) that leave no larger gap to the surfaces: the
  /// gaps of both bodies together for two packings, that of the packing for another shape. Features that are
  /// finer are felt later, or not at all; depths are measured on the surfaces all the same. Never more
  /// spheres than PackingShape::sphereCount(). 0: that many. A packing without a surface uses them in any
  /// case.
  double accuracy = 0;
  /// Pressure that a metre of overlap causes [N/m^3]: a contact pushes with stiffness times overlap volume,
  /// which the spheres alone decide. 0: a default, which is for
  ///
  /// Response::compliant: as stiff as ten iterations of Bullet's solver bring to rest, which is
  /// 24 m / dt^2 (1 + depth / (0.002 s)) with m the reduced mass of the pair and s the size of the smaller
  /// body, divided among the points that push the same way: a body that lies still sinks by 0.1 mm at 60 Hz,
  /// whatever its mass. Depth is measured on the solids' surfaces, so bodies meet where they are drawn;
  ///
  /// Response::penalty: m / (dt^2 pi R^2), with R the radius of the smaller body's bounding sphere, which the
  /// step dt resolves: a body at rest sinks by g dt^2 pi R^2 / A, A the area of the contact.
  ///
  /// Response::rigid has no stiffness.
  double stiffness = 0;
  /// Of a contact: 0 is bouncy, 1 has no rebound from the spring itself. Fraction of critical damping; of
  /// four times that for Response::compliant with its default stiffness. Bullet's restitution works on top of
  /// it; with Response::penalty a restitution above 0 sets the damping in its place, if that is less.
  double damping = 1;
  /// The least that is done for a pair in a step. By default contacts that were found are used again while
  /// bodies hardly move against each other. Reuse::search takes several times as long; it is for tests and
  /// measurements, and to find out where a fault lies. See ContactStatistics.
  Reuse reuse = Reuse::idle;
};

inline namespace INNERSPHERE_BULLET_PRECISION {

/// The options of a pair: `a` and `b` are those that its shapes have of their own, null for none, and `world`
/// those of the dispatcher.
///
/// Backend, estimator and reuse are the dispatcher's in any case, because one query serves all of its pairs.
/// The rest is the dispatcher's if neither shape has its own, and the shape's if one has. If both have:
///   - response: theirs if it is the same. Else Response::rigid counts as infinitely stiff and gives way to
///     the other, and Response::penalty gives way to Response::compliant, which is stable at any step;
///   - stiffness: that of two springs in series, 1 / (1/a + 1/b), so that two equal bodies are half as stiff
///     as one of them against a body without options. The default stiffness, 0, is as stiff as the step
///     resolves: it counts as infinitely stiff, as Response::rigid does;
///   - damping: the mean, weighted by 1/stiffness: the softer body has more say, and all of it if only
///     one has a stiffness;
///   - accuracy: the finer one; 0, which is all spheres, is the finest.
ContactOptions combine(const ContactOptions& world, const ContactOptions* a, const ContactOptions* b);

}  // namespace INNERSPHERE_BULLET_PRECISION

}  // namespace innersphere
