// Holds all pairs of one dispatcher that have a packing in them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "innersphere/contact_options.hpp"
#include "innersphere/contact_statistics.hpp"
#include "pair_cache/contact_pair.hpp"
#include "pair_cache/packing_search.hpp"
#include "pair_cache/pair_list.hpp"
#include "pair_cache/reuse.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Keeps all pairs up to date. Bullet asks for one pair at a time and does not say when a step begins. But
/// where a pair has moved since the last update of all pairs, time has gone on, and another update brings all
/// of them up to date that were asked for since, with all threads and one query. Pairs that are new since
/// then, or that it has left out, are brought up to date alone.
///
/// An update goes through these stages: snapshots of the bodies; for each pair, what can be reused (see
/// reuse.hpp); searches begin; meanwhile contacts are transported and refined; the results of the searches;
/// and each pair's contacts are written into Bullet's manifolds as soon as they are known.
///
/// Safe to use from several threads at once. While the table is locked no code of the user's is called but
/// that of a concave shape of their own, which is asked for its triangles.
class PairTable {
 public:
  explicit PairTable(btDispatcher* dispatcher) : dispatcher_(dispatcher) {}

  /// Sets the options, and forgets all contacts that were found with others. They are checked by who
  /// registers.
  void setOptions(const ContactOptions& options);
  ContactOptions options() const;
  /// Sets the world whose solver contacts are for; it must live as long as pairs are dispatched. Null means
  /// Bullet's defaults.
  void setWorld(btDynamicsWorld* world);
  /// Says in the log, once after each setWorld(), that the solver lacks what friction needs, if it did when
  /// bodies touched first. The table is not locked then: the log may ask it something.
  void logSolver();

  /// Returns a new pair. It stays at its address until it is removed, which gives its manifolds back.
  ContactPair& add();
  void remove(ContactPair& pair);

  /// Does what there is to do for a pair that Bullet asks for: writes its contacts through `result`, unless
  /// the last update, or one that is due now, has published them. `swapped` says that B is Bullet's first
  /// body.
  void process(ContactPair& pair, const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
               bool swapped, const btDispatcherInfo& dispatch, btManifoldResult* result);
  /// Answers one closest-point query, for a pair that is in no table.
  void report(ContactPair& pair, const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
              btManifoldResult* result);

  /// Makes a pair take part in the next update though Bullet has not asked for it yet.
  void announce(ContactPair& pair, const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b);
  /// Begins an update of all pairs that were asked for since the last one. A device works on while Bullet
  /// collides other pairs: the first one of the table that is asked for waits for it.
  void beginUpdate(btScalar time_step);
  /// Waits for the update that beginUpdate() began.
  void finishUpdate();
  /// Compares all bodies with what they were in the last update: for the isDone() that follow.
  void compareBodies();
  /// Returns true if the last update has published the contacts of a pair of whole bodies as they are now.
  /// Does not lock the table: for one that nobody else uses meanwhile.
  bool isDone(const ContactPair& pair, btScalar time_step) const;

  /// Returns all pairs that touch, in the order in which they came. Throws Error from the queries for their
  /// volumes.
  std::vector<PairOverlap> overlaps();
  void appendManifolds(btManifoldArray& manifolds) const;

  ContactStatistics statistics() const;

 private:
  struct Job {
    ContactPair* pair = nullptr;  ///< null: nothing to do
    Reuse reuse = Reuse::idle;
    SearchPass pass = SearchPass::none;
  };

  void list(ContactPair& pair);
  void unlist(ContactPair& pair);
  BodySnapshot* use(const PairSide& side);
  void release(const BodySnapshot* body);
  void take(ContactPair& pair, const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
            bool swapped);
  bool isDone(const ContactPair& pair, const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
              btScalar time_step, btScalar separation) const;

  // The stages of an update of all pairs; the table is locked.
  void begin(btScalar time_step);
  void noteWays();
  void countNeighbours();
  Job decide(ContactPair& pair) const;
  void collectJobs();
  void work();
  void publish(ContactPair& pair);
  void finish();

  /// Returns true if the last update has published the pair, and Bullet has not asked for it since.
  bool isFresh(const ContactPair& pair, btScalar time_step) const {
    return pair.published && pair.step == number_ && !pair.asked && time_step == settings_.time_step;
  }
  /// Brings one pair up to date; the table is not locked. Returns false if that cannot be done, which the log
  /// says.
  bool updateOrLog(ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b,
                   const StepSettings& settings);
  /// Does the same without the log. Throws Error from the query.
  void updateAlone(ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b,
                   const StepSettings& settings);
  void push(ContactPair& pair, const StepSettings& settings, const btDispatcherInfo& dispatch);
  Overlap overlapOf(const ContactPair& pair, PackingSearch& search) const;
  /// Looks at the solver when bodies touch first.
  void noticeContact(const ContactPair& pair, const StepSettings& settings);
  void count(Reuse reuse);
  StepSettings settingsFor(btScalar time_step) const;

  std::unique_ptr<PackingSearch> takeSearch();
  void giveBack(std::unique_ptr<PackingSearch> search);

  btDispatcher* const dispatcher_;
  mutable std::mutex mutex_;
  ContactOptions options_;
  btDynamicsWorld* world_ = nullptr;
  std::atomic<bool> awaits_contact_{false};    ///< no bodies have touched since the world was set
  std::atomic<bool> lacks_directions_{false};  ///< as the log is to say
  std::deque<ContactPair> places_;
  std::vector<ContactPair*> unused_;
  PairList<ContactPair> pairs_;
  std::unordered_map<const btCollisionObject*, BodySnapshot> bodies_;
  PairList<BodySnapshot> body_list_;  ///< the same, to go through

  std::uint64_t number_ = 1;               ///< of the last update
  StepSettings settings_;                  ///< of it
  std::vector<Job> jobs_;                  ///< of it, by places in pairs_
  std::vector<Job> work_;                  ///< those of them that need no query
  std::unique_ptr<PackingSearch> search_;  ///< those that need one; null once they are finished
  std::vector<std::unique_ptr<PackingSearch>> spare_searches_;
  int updates_without_search_ = 0;  ///< since the last one
  std::uint64_t dispatches_ = 0;    ///< steps of the world in which penalty forces have acted
  ContactStatistics statistics_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
