// Says what the friction of a patch is told, whose points Bullet's solver treats one by one.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "common/pair_motion.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/contact_transport.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns what the friction of a patch could bear in the last step, in one direction [N s].
btScalar mostFriction(const btPersistentManifold& manifold);

/// Returns how far A has slipped on B at this point, along the surface [m]. The cached point carries it from
/// step to step, as the distance of its two places on the bodies, which are at `start`: Bullet's friction
/// knows no more than speeds, and what ten iterations leave of them adds up to bodies that creep. Bodies that
/// roll touch at `place` now, with another `normal`: the slip is how much further the place has gone on B's
/// surface than on A's in a step of `time_step` [s] in which they turned as in `motion`. Each way is that of
/// a circle between its two normals: by its chord, what rolls fast would slip. As a bristle that bends until
/// it slides, it is no longer than `largest` [m]: a longer one would ask for more than friction bears, in all
/// directions that the solver's pyramid has, whose corners bear more than the cone does. It is 0 beyond
/// `farthest` [m], and where bodies turn so far in a step.
btVector3 slipOf(const btManifoldPoint& cached, const Placed& start, const PairMotion& motion,
                 const btVector3& place, const btVector3& normal, btScalar time_step, btScalar largest,
                 btScalar farthest);

/// Returns the share of friction at the points of a patch, in (0, 1], that takes as much energy as friction
/// all over it does. Points lie at the rim, where bodies that turn on each other slide faster than within,
/// and would brake a disc half too strongly. While all of them slide, with V the speed at the centre of
/// pressure, w that of turning about the normal, r the mean distance of the patch's area from its centre and
/// p that of the points, weighted by what they bore in the last step,
///   share^2 = (V^2 + (w r)^2 / 2) / (V^2 + (w p)^2 / 2).
/// Exact where bodies only slide, or only turn. 1 where friction holds, at least 1/2: that of a line.
btScalar slidingShare(const PairMotion& motion, const ContactPatch& patch,
                      const btPersistentManifold& manifold);

/// Returns the lever of the friction that brakes a round contact which spins [m], at a depth [m] where the
/// curvatures of both surfaces add up to `curvature` [1/m] and the bodies turn against each other by `spin`
/// [rad/s]. In place it is the mean distance of the pressure from the middle: 3 pi / 16 of the radius
/// a = sqrt(depth / curvature) of Hertz's contact. Bodies that roll on as well, by v = |spin x n| / curvature
/// [m/s], leave behind what they rub: of the lever the share w a / v is left, the angle by which they spin
/// about the normal on the way over the contact, up to a radian. Depth is what the solver needs, not that of
/// a material: with all of the lever, a ball in a groove would be braked as if it were soft. It is 0 where
/// surfaces are flat, or apart.
btScalar spinningLever(btScalar depth, btScalar curvature, const btVector3& spin, const btVector3& normal);

/// Returns how fast the line of the push between bodies that rock on each other gets past their centres
/// [m/s], as far as a step of `time_step` [s] does not resolve it. Where they tilt by t along an axis in
/// which they bend by A and B, they touch t / (A + B) further on, and it gets past A's centre, h under the
/// surface, by
///   l t = (1 - h A) / (A + B) t.
/// The smaller l of A's and B's counts, of those that can be moved. Their load N, which has given them the
/// impulse `load` [N s] in the last step, makes that a stiffness N l which holds them upright: about the
/// place, where their inertia is I, they swing by w = sqrt(N l / I). With the push at the end of the step
/// amplitudes fall by w^2 dt / 2 in a second, and what a step cannot tell comes to rest. Of that the part
/// (w dt)^2 is left, 1 at most: what a step resolves goes on rocking, as its brake falls with dt^3. It is 0
/// where what is round rolls, on whatever, and in axes along which the surfaces are flat together, for the
/// smaller body's `size` [m]. The speed is that by which the load does as much work about all that the bodies
/// tilt as in both axes together.
btScalar rockingSpeed(const ContactPoint& point, const btVector3& place, const PairMotion& motion,
                      const btCollisionObject& a, const btCollisionObject& b, btScalar size, btScalar load,
                      btScalar time_step);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
