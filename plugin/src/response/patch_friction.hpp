// Says what the friction of a patch is told, whose points Bullet's solver treats one by one.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "common/pair_motion.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/contact_transport.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns what the friction of a patch could bear in the last step, in one direction [N s].
btScalar mostFriction(const btPersistentManifold& manifold);

/// Returns how far A has slipped on B at this point, along the surface [m]. The cached point carries it from
/// step to step, as the distance of its two places on the bodies, which were at `start`: Bullet's friction
/// knows no more than speeds, and what ten iterations leave of them adds up to bodies that creep. As a
/// bristle that bends until it slides, it is no longer than `largest` [m]: a longer one would ask for more
/// than friction bears, in all directions that the solver's pyramid has, whose corners bear more than the
/// cone does. It is 0 beyond `farthest` [m].
btVector3 slipOf(const btManifoldPoint& cached, const Placed& start, const btVector3& normal,
                 btScalar largest, btScalar farthest);

/// Returns the share of friction at the points of a patch, in (0, 1], that takes as much energy as friction
/// all over it does. Points lie at the rim, where bodies that turn on each other slide faster than within,
/// and would brake a disc half too strongly. While all of them slide, with V the speed at the centre of
/// pressure, w that of turning about the normal, r the mean distance of the patch's area from its centre and
/// p that of the points, weighted by what they bore in the last step,
///   share^2 = (V^2 + (w r)^2 / 2) / (V^2 + (w p)^2 / 2).
/// Exact where bodies only slide, or only turn. 1 where friction holds, at least 1/2: that of a line.
btScalar slidingShare(const PairMotion& motion, const ContactPatch& patch,
                      const btPersistentManifold& manifold);

/// Returns the mean distance of the pressure of a round contact from its middle [m], at a depth [m] where the
/// curvatures of both surfaces add up to `curvature` [1/m]: 3 pi / 16 of the radius sqrt(depth / curvature)
/// of Hertz's contact. It is 0 where they are flat, or apart.
btScalar spinningLever(btScalar depth, btScalar curvature);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
