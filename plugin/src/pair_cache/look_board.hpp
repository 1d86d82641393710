// When all pairs are looked at at once, and what has to be known of them when Bullet asks for one.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "common/motion_bound.hpp"
#include "pair_cache/body_side.hpp"
#include "pair_cache/pair_list.hpp"

class btRigidBody;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A body as it was at the last look.
class SeenBody {
 public:
  explicit SeenBody(const btCollisionObject& object);

  void see();
  bool isAsSeen(const btCollisionObjectWrapper& wrapper) const;
  /// Notes whether it is still as it was seen; else it is taken to be.
  void check();
  bool isStill() const { return still_; }

  const btCollisionObject* object() const { return object_; }
  const btTransform& transform() const { return transform_; }
  const Motion& motion() const { return motion_; }
  bool isActive() const { return active_; }
  /// It has got another shape, or its packing has been changed, since the look before.
  bool hasChanged() const { return changed_; }
  /// No point of it has gone further since it was seen first [m].
  double way() const { return way_; }

  std::size_t users = 0;       ///< pairs
  std::size_t list_index = 0;  ///< see PairList

 private:
  bool isAsSeen(const btTransform& transform) const;

  const btCollisionObject* object_;
  const btRigidBody* body_;  ///< null if it is none
  const btCollisionShape* shape_ = nullptr;
  const PackingShape* packing_ = nullptr;
  std::size_t version_ = 0;  ///< of the packing shape
  btTransform transform_;
  btVector3 velocity_{0, 0, 0};
  btVector3 spin_{0, 0, 0};
  Motion motion_;
  double way_ = 0;
  bool active_ = true;
  bool changed_ = true;
  bool still_ = true;
};

/// What a pair knows of the looks at all pairs.
struct Look {
  std::size_t number = 0;       ///< of the last one that it was part of, or that came before it
  bool wanted = false;          ///< asked for since the last one that it was part of
  bool received = false;        ///< that one has handed out the pair's contacts
  bool calm = false;            ///< there are none, and will be none for a while: see LookBoard::calm()
  btScalar calm_within = 0;     ///< as long as the bodies come no nearer than this in a step [m],
  double calm_to = 0;           ///< until they have gone this far, both ways together [m]
  const SeenBody* a = nullptr;  ///< null where a shape is the child of a compound
  const SeenBody* b = nullptr;
  /// The pair that Bullet asked for a little later last time, and its algorithm: to be fetched ahead.
  const Look* ahead = nullptr;
  const void* algorithm_ahead = nullptr;

  /// What is known of the pair does not hold any more.
  void reset() { received = calm = false; }
};

/// What a look at a pair reads, in two goes: most pairs are calm, and then that is all.
template <typename Pair>
void fetchLook(const Pair& pair) {
  fetch(pair.look);
}
template <typename Pair>
void fetchUnlessCalm(const Pair& pair) {
  if (!pair.look->calm) fetch(&pair);
}

/// Bullet asks for one pair at a time and does not tell when a step begins. But where a pair has moved since
/// the last look at all pairs, time has gone on, and another look brings all of them up to date that were
/// asked for since, with all threads or in one launch. Pairs that are new since the last look, or that it
/// left out, are brought up to date alone.
///
/// Most pairs of a pile do not touch: asking for them costs what it takes to find out that there is nothing
/// to do. So what that needs is kept here, close together for all pairs.
class LookBoard {
 public:
  std::mutex& mutex() const { return mutex_; }

  Look* add(const BodySide& a, const BodySide& b);
  void remove(Look* look);

  /// True if a pair needs nothing more in this step: the last look has handed out its contacts, and its
  /// bodies are as they were then. Locks the mutex. `algorithm`: the pair's.
  bool isDone(Look& look, const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
              btScalar time_step, const void* algorithm);

  /// The same for many pairs, by all threads and without the mutex, if nothing has moved since the look, or
  /// since check().
  void check();
  bool isDone(const Look& look, btScalar time_step) const;

  /// Whether a pair that has moved shows that it is time for another look.
  bool isDue(const Look& look) const { return look.number == number_; }
  void begin(btScalar time_step);
  /// True if the pair was asked for: then it is part of the look.
  bool join(Look& look) const {
    if (look.wanted) look.number = number_;
    return look.wanted;
  }
  /// Notes that a pair has no contacts, and will have none until its bodies have moved on by `leeway`, as
  /// long as they come no nearer than `within` in a step [m].
  void calm(Look& look, btScalar leeway, btScalar within) const;
  /// Whether that holds in this look, which the pair is part of: then there is nothing to do for it.
  bool staysCalm(Look& look) const;
  /// Takes the two sides of a pair that stayed calm to where they were in the last look.
  static void follow(const Look& look, BodySide& a, BodySide& b);
  /// Bullet asks for the pair.
  void ask(Look& look) const {
    look.wanted = true;
    look.number = number_;
  }
  /// It has been brought up to date in the last look, and not been asked for since.
  bool isFresh(const Look& look) const { return look.number == number_ && !look.wanted; }

 private:
  /// The last look has handed out the contacts of a pair of whole bodies.
  bool hasDelivered(const Look& look, btScalar time_step) const;
  void fetchAhead(Look& look, const void* algorithm);
  const SeenBody* use(const BodySide& side);
  void release(const SeenBody* body);

  mutable std::mutex mutex_;
  std::size_t number_ = 1;
  btScalar time_step_ = 0;
  std::deque<Look> looks_;
  std::array<Look*, 8> asked_{};  ///< last, in turn
  std::size_t next_ = 0;          ///< of them to be replaced
  std::vector<Look*> unused_;
  std::unordered_map<const btCollisionObject*, SeenBody> bodies_;
  PairList<SeenBody> seen_;  ///< the same, to go through
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
