// All pairs of packings of one dispatcher, queried together.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "innersphere/contact_options.hpp"
#include "innersphere/query.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/contact_settings.hpp"
#include "narrow_phase/contact_transport.hpp"
#include "pair_cache/body_side.hpp"
#include "pair_cache/contact_receiver.hpp"
#include "pair_cache/look_board.hpp"
#include "pair_cache/pair_list.hpp"
#include "shape/placed_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// The contact of two packings.
struct PackingContact : ListedPair {
  PackingContact(const PackingSide& first, const PackingSide& second, ContactReceiver& where_to)
      : receiver(where_to), a(first), b(second) {}

  // What is read when Bullet asks for the pair comes first: pairs are many and far from each other in memory.
  ContactReceiver& receiver;
  Look own_look;
  Look* look = &own_look;   ///< the board's once it has been added
  bool valid = false;       ///< what is known of the contact belongs together
  btScalar separation = 0;  ///< asked for; see ContactSettings
  btScalar time_step = 0;   ///< within which contacts may close [s]
  btScalar needed = 0;      ///< patches are, or will be, right for gaps up to this [m]
  PackingSide a;
  PackingSide b;
  std::optional<ContactSettings> measure;  ///< of the last query
  Placed placed() const { return {a.transform, b.transform}; }

  ContactTransport memory;              ///< its samples are indices of contacts
  std::vector<SphereContact> contacts;  ///< those that are samples
  std::size_t count_a = 0;              ///< of A's spheres, which come first
  Overlap overlap;                      ///< only where depth is not measured on the surfaces
  bool deep = false;                    ///< the surfaces are not near each other, and yet the solids overlap
};

/// What a batch has done since it was made.
struct BatchCount {
  std::size_t launches = 0;  ///< of queries for all pairs that needed one
  std::size_t pairs = 0;     ///< that were in them
  std::size_t measured = 0;  ///< pairs that were measured again without a query
};

/// Looks at all pairs at once: see LookBoard. A look makes one query for all pairs that need one, so that a
/// step costs one launch, and one more for each pair that is new. A launch is up to three queries, one after
/// the other: see Task. Pairs that have moved less than what a query leaves room for are measured again where
/// it found contact, and those that have hardly moved at all take their contacts along. Safe to use from
/// several threads at once.
class OverlapBatch {
 public:
  /// Error no_device if the options ask for CUDA by name and there is none.
  void setOptions(const ContactOptions& options);

  void add(PackingContact* contact);
  void remove(PackingContact* contact);

  /// True if the last look, or one that is due now, has handed out the patches of `contact` for two bodies as
  /// they are now: then there is nothing left to do.
  bool hasDelivered(PackingContact& contact, const btCollisionObjectWrapper& a,
                    const btCollisionObjectWrapper& b, btScalar separation);

  /// Brings `contact` up to date for two sides and returns its patches. It need not have been added; then it
  /// is queried alone. Throws Error from the query.
  const std::vector<ContactPatch>& update(PackingContact& contact, const PackingSide& a, const PackingSide& b,
                                          btScalar separation);

  /// What two packings share as they were in the last update of `contact`. Throws Error from the query.
  Overlap volumesOf(PackingContact& contact);

  /// Looks at all pairs now that will be asked for in this step: those that were in the step before, and
  /// `fresh` ones. Errors wait until update() asks for the pair.
  /// A device works on while Bullet collides other pairs: the first one that is asked for waits for it.
  void launch(const std::vector<PackingContact*>& fresh, btScalar time_step);
  /// Waits for it.
  void finish();

  BatchCount count() const;

  /// What tells whether there is anything to do for a pair.
  LookBoard& looks() { return looks_; }

 private:
  QueryContext& context();
  using Age = ContactTransport::Age;
  Age ageOf(const PackingContact& contact, const PackingSide& a, const PackingSide& b) const;
  bool isUpToDate(const PackingContact& contact, const PackingSide& a, const PackingSide& b) const;
  /// What is left to do for a pair.
  enum class Task : std::uint8_t {
    nothing,
    carry,     ///< its contacts go along
    measure,   ///< its samples for contacts are measured again
    surfaces,  ///< a query, with spheres enlarged so that they find all contact of the surfaces they stand
               ///< for
    touch,     ///< one with spheres as they are, where the surfaces showed no overlap: it may be too deep
    deep,      ///< one with spheres enlarged so that they fill their solids, where it is
    volumes,   ///< one where the volume of overlap is all that is wanted
  };
  static bool needsQuery(Task task) { return task >= Task::surfaces; }
  struct Job {
    PackingContact* contact;
    Task task;
  };
  std::vector<Job>& jobsLike(Task task) { return needsQuery(task) ? searches_ : work_; }
  /// Begins a look; finishLook() ends it, after which errors have been left to update().
  void lookAtAll(btScalar time_step);
  void finishLook();
  Task lookAt(PackingContact& contact, btScalar time_step) const;
  Task place(PackingContact& contact, const PackingSide& a, const PackingSide& b) const;
  void updateAlone(PackingContact& contact, const PackingSide& a, const PackingSide& b);
  void workWithoutQuery(PackingContact& contact, Task task) const;
  void handOut(PackingContact& contact) const;
  void startQueries();
  void takeStarted(bool hand_out);
  void finishQueries(bool hand_out);
  void countJobs();
  void makeQueries(Task task);
  void takeResults(Task task, bool hand_out);
  QueryOptions optionsOf(Task task) const;
  btScalar neededSeparation(const PackingContact& contact) const;
  PairQuery makeQuery(Task task, const PackingContact& contact) const;
  Task takeResult(Task task, std::size_t index, PackingContact& contact) const;

  BatchCount count_;
  ContactOptions options_;
  std::unique_ptr<QueryContext> context_;  ///< made by the first query
  LookBoard looks_;
  PairList<PackingContact> live_;
  std::vector<Task> tasks_;    ///< by places in live_
  std::vector<Job> work_;      ///< those of them without a query
  std::vector<Job> searches_;  ///< and with one
  std::vector<Job*> queried_;
  std::vector<PairQuery> queries_;
  QueryResult result_;
  bool under_way_ = false;  ///< a look has begun
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
