// Holds what one dispatcher was told, shared by its algorithms.
#pragma once

#include <deque>
#include <memory>

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "pair_cache/pair_table.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

class Registration;

/// This is an entry of a dispatcher's table. Pairs without a packing go to what was there before.
class CreateFunc : public btCollisionAlgorithmCreateFunc {
 public:
  CreateFunc(Registration& registration, btCollisionAlgorithmCreateFunc* previous, bool closest)
      : registration_(registration), previous_(previous), closest_(closest) {}
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* body0,
                                                 const btCollisionObjectWrapper* body1) override;

  Registration& registration() const { return registration_; }

 private:
  Registration& registration_;
  btCollisionAlgorithmCreateFunc* previous_;  ///< for shapes that share our type number
  bool closest_;
};

/// Holds the table of pairs of one dispatcher, and fills the dispatcher's own table of algorithms.
class Registration : public std::enable_shared_from_this<Registration> {
 public:
  explicit Registration(btCollisionDispatcher* dispatcher) : dispatcher_(dispatcher), table_(dispatcher) {}

  /// Returns the registration of a dispatcher, which is made on first use and kept until remove(), or to the
  /// end of the process: a dispatcher does not tell when it goes, and its table refers to our functions until
  /// then.
  static Registration& of(btCollisionDispatcher* dispatcher);
  /// Returns the registration, or null if there is none.
  static std::shared_ptr<Registration> find(const btCollisionDispatcher* dispatcher);
  /// Takes the registration from a dispatcher. What is kept for it lives as long as pairs do.
  static void remove(btCollisionDispatcher* dispatcher);
  /// Drops all registrations of a dispatcher that is gone, without touching it.
  static void forget(const btDispatcher* gone) noexcept;

  PairTable& table() { return table_; }

 private:
  void fillTables(btCollisionDispatcher* dispatcher);

  const btDispatcher* const dispatcher_;  ///< to be compared; it may be gone
  PairTable table_;
  std::deque<CreateFunc> create_funcs_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
