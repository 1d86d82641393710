// What one dispatcher was told, shared by its algorithms.
#pragma once

#include <deque>
#include <memory>
#include <mutex>

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "bullet/step_count.hpp"
#include "innersphere/contact_options.hpp"
#include "pair_cache/overlap_batch.hpp"
#include "pair_cache/pair_list.hpp"
#include "pair_cache/surface_batch.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

class PairContact;
class Registration;

/// An entry of a dispatcher's table.
class CreateFunc : public btCollisionAlgorithmCreateFunc {
 public:
  CreateFunc(Registration& registration, btCollisionAlgorithmCreateFunc* previous, bool closest)
      : registration_(registration), previous_(previous), closest_(closest) {}
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* body0,
                                                 const btCollisionObjectWrapper* body1) override;

 private:
  Registration& registration_;
  btCollisionAlgorithmCreateFunc* previous_;  ///< for shapes that share our type number
  bool closest_;
};

class Registration : public std::enable_shared_from_this<Registration> {
 public:
  /// The registration of a dispatcher, made on first use and kept until take(), or to the end of the process:
  /// a dispatcher does not tell when it goes, and its table refers to our functions until then.
  static std::shared_ptr<Registration> of(btCollisionDispatcher* dispatcher);
  /// The same, or null if there is none.
  static std::shared_ptr<Registration> find(btCollisionDispatcher* dispatcher);
  /// The same; from now on the dispatcher has none.
  static std::shared_ptr<Registration> take(btCollisionDispatcher* dispatcher);

  void setOptions(const ContactOptions& options);
  ContactOptions options() const;

  /// Writes our functions into the dispatcher's tables.
  void fillTables(btCollisionDispatcher* dispatcher);
  /// Writes back what its configuration started it with.
  static void clearTables(btCollisionDispatcher* dispatcher);
  /// Whether our functions are there. Unlike find(), it is not misled by a dispatcher that was destroyed, and
  /// another that has taken its address.
  static bool hasTables(const btCollisionDispatcher& dispatcher);

  OverlapBatch& batch() { return batch_; }
  SurfaceBatch& surfaces() { return surfaces_; }
  StepCount& steps() { return steps_; }
  /// Held while a pair is processed, in which a look at all pairs may write their contacts, and penalty
  /// forces write to the bodies: a dispatcher may process several at once.
  std::recursive_mutex& processing() { return processing_; }
  /// That Bullet has algorithms for.
  SharedPairList<PairContact>& pairs() { return pairs_; }

 private:
  mutable std::mutex mutex_;
  std::recursive_mutex processing_;  ///< callbacks of the user's may ask for contacts
  ContactOptions options_;
  OverlapBatch batch_;
  SurfaceBatch surfaces_;
  StepCount steps_;
  SharedPairList<PairContact> pairs_;
  std::deque<CreateFunc> create_funcs_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
