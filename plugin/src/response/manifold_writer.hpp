// Keeps the persistent manifolds of one pair of bodies.
#pragma once

#include <vector>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "common/pair_motion.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/contact_transport.hpp"
#include "response/contact_law.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Has one manifold for each patch. A patch keeps its manifold from step to step, and a point its place in
/// it, so that Bullet's warm starting works; points that were not found again are removed. Manifolds are
/// given back only at the end, because btCollisionDispatcherMt cannot release a manifold in the dispatch that
/// made it.
class ManifoldWriter {
 public:
  explicit ManifoldWriter(btDispatcher* dispatcher) : dispatcher_(dispatcher) {}
  ~ManifoldWriter() { clear(); }
  ManifoldWriter(const ManifoldWriter&) = delete;
  ManifoldWriter& operator=(const ManifoldWriter&) = delete;

  /// Replaces the contacts between `a` and `b`, which were at `start` when the step began and move like
  /// `motion`. `origin` is that of A's packing in the world. Points up to `separation` [m] apart are kept.
  void write(const btCollisionObject& a, const btCollisionObject& b, const Placed& start,
             const PairMotion& motion, const btVector3& origin, const std::vector<ContactPatch>& patches,
             const ContactLaw& law, btScalar separation, btManifoldResult* result);

  /// Only tells `result` of the contacts, as closest-point queries want it: keeps nothing and makes no
  /// manifold.
  static void report(const btCollisionObject& a, const btCollisionObject& b, const btVector3& origin,
                     const std::vector<ContactPatch>& patches, btManifoldResult* result);

  /// Gives the manifolds back to the dispatcher.
  void clear();
  void append(btManifoldArray& manifolds) const;
  std::size_t size() const { return entries_.size(); }
  btDispatcher& dispatcher() const { return *dispatcher_; }

 private:
  struct Entry {
    btPersistentManifold* manifold;
    btScalar threshold;   ///< its own, at which Bullet drops contacts [m]
    btScalar processing;  ///< its own: the solver leaves points alone that are further apart [m]
    btVector3 normal;     ///< of its last patch, in the frame of a
    btVector3 centre;
  };
  void assign(const btTransform& to_a, const std::vector<ContactPatch>& patches);
  void provide(const btCollisionObject& a, const btCollisionObject& b, std::size_t count);

  btDispatcher* dispatcher_;
  std::vector<Entry> entries_;
  std::vector<int> owner_;  ///< for each entry, the patch it holds now, or -1
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
