// What a pair of bodies with a packing in it remembers from step to step.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "bullet/registration.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "pair_cache/overlap_batch.hpp"
#include "pair_cache/surface_batch.hpp"
#include "response/manifold_writer.hpp"
#include "response/penalty.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A is the body with the packing, or the first of two packings.
class PairContact : public ContactReceiver, public ListedPair {
 public:
  /// `closest`: for one closest-point query, without touching the dispatcher's manifolds.
  PairContact(btDispatcher* dispatcher, std::shared_ptr<Registration> registration, bool closest);
  ~PairContact() override;
  PairContact(const PairContact&) = delete;
  PairContact& operator=(const PairContact&) = delete;

  /// `swapped`: B is the first body for Bullet.
  void process(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b, bool swapped,
               const btDispatcherInfo& dispatch, btManifoldResult* result);

  /// Where it is on a board of all pairs, if it is.
  struct Place {
    LookBoard* board = nullptr;
    Look* look = nullptr;
    bool swapped = false;  ///< B is the first body for Bullet
  };
  Place place() const;

  /// Tells the batch of a pair before it is processed. Returns it if it is one of packings that the batch did
  /// not know.
  PackingContact* announce(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                           btScalar time_step);

  void appendManifolds(btManifoldArray& manifolds) const { manifolds_.append(manifolds); }

  /// As of the last call of process(), with the impulses that the solver found since then. False if nothing
  /// touches.
  bool read(PairOverlap& overlap);

 private:
  bool hasReceived(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                   const btManifoldResult& result, btScalar time_step);
  bool receive(const std::vector<ContactPatch>& patches, const ContactOptions& options,
               btScalar time_step) override;
  void fetchManifolds() const override { manifolds_.fetch(); }
  static bool isPlain(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                      const btManifoldResult& result);
  const std::vector<ContactPatch>& update(const btCollisionObjectWrapper& a,
                                          const btCollisionObjectWrapper& b, btScalar separation);
  void look(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b, btScalar time_step);
  bool provide(const PackingSide& a, const PackingSide& b);
  ContactLaw lawOf(const ContactOptions& options, btScalar time_step) const;
  void push(const ContactLaw& law, const btDispatcherInfo& dispatch, const btManifoldResult& result);
  Overlap overlap();
  /// Of A's packing in the world, and where the torque of overlap() acts.
  btVector3 origin() const;
  btVector3 arm() const;
  void forget();
  void report(const std::string& message);

  btDispatcher* const dispatcher_;
  const std::shared_ptr<Registration> registration_;
  const bool closest_;
  bool reported_ = false;
  bool swapped_ = false;    ///< B is the first body for Bullet
  bool plain_ = false;      ///< see isPlain()
  ContactOptions options_;  ///< of the last call
  const btCollisionObject* object_a_ = nullptr;
  const btCollisionObject* object_b_ = nullptr;
  const btCollisionShape* shape_a_ = nullptr;
  const btCollisionShape* shape_b_ = nullptr;
  btTransform transform_a_;
  btTransform transform_b_;
  btScalar time_step_ = 0;         ///< of the last step [s]
  btScalar depth_ = 0;             ///< of the deepest contact; negative: of the gap [m]
  std::uint64_t pushed_step_ = 0;  ///< when penalty forces acted last
  PenaltyReport penalty_;
  std::optional<PackingContact> packings_;
  std::optional<SurfacePair> surface_;
  ManifoldSet manifolds_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
