// Holds a pair of bodies with a packing in it: what is known of its contact, and what Bullet was told of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "innersphere/pair_overlaps.hpp"
#include "narrow_phase/packing_vs_packing.hpp"
#include "narrow_phase/packing_vs_shape.hpp"
#include "pair_cache/body_snapshot.hpp"
#include "pair_cache/pair_side.hpp"
#include "response/manifold_writer.hpp"
#include "response/penalty.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Says how long bodies stay apart. Bodies without contacts stay apart until they have travelled too far, or
/// could close too wide a gap within one step.
struct SafeDistance {
  bool known = false;
  std::uint32_t changes = 0;  ///< of both bodies' shapes, together
  btScalar separation = 0;    ///< as long as they come no nearer than this in a step [m],
  double travel = 0;          ///< until both together have travelled this far [m]
};

/// Holds what is the same for all pairs in a step.
struct StepSettings {
  ContactOptions options;  ///< of the dispatcher
  SolverSettings solver;
  btScalar time_step = 0;  ///< [s]
};

/// Holds one pair. A is the body with the packing, or the first of two packings.
struct ContactPair {
  explicit ContactPair(btDispatcher* dispatcher) : manifolds(dispatcher) {}

  /// Takes the pair as Bullet asks for it. `is_swapped` says that B is the first body for Bullet.
  void set(const btCollisionObjectWrapper& wrapper_a, const btCollisionObjectWrapper& wrapper_b,
           bool is_swapped);
  /// Notes the shapes as they are when a search begins, with the options that they have together.
  void noteShapes(const ContactOptions& world_options);
  /// Forgets all contacts that were found.
  void forgetContact();
  /// Makes it a new pair, and gives the manifolds back.
  void clear();

  /// Returns where both were when the step of the last update began.
  Placed placed() const { return {a.start, b.start}; }
  /// Returns the origin of A's packing in the world, which contacts are relative to.
  btVector3 origin() const;

  /// Returns true if any thread may write the contacts, at any time of a step: Bullet asks for the pair as it
  /// does of itself, and for no child of a compound, which it names in the points; no code of the user's has
  /// a part in it; and there are manifolds enough, which only the dispatcher makes.
  bool canBePublished() const;
  /// Writes the contacts into the manifolds through a result of its own.
  void publish(const StepSettings& settings, const BodySnapshot& body_a, const BodySnapshot& body_b);
  /// Writes the contacts through Bullet's `result`.
  void write(const StepSettings& settings, const BodySnapshot& body_a, const BodySnapshot& body_b,
             btManifoldResult* result);
  /// Tells `result` of contacts of the pair, and leaves the manifolds alone.
  void report(const std::vector<ContactPatch>& patches, btManifoldResult* result) const;

  /// Returns the law of the pair in a step. A law of the user's own on a body takes the place of ours.
  ContactLaw lawOf(const StepSettings& settings) const;
  /// Returns true if the manifolds hold contact points.
  bool hasPoints() const;
  /// Returns true if the solver is to hold the points by friction. Penalty forces have their own.
  bool hasFriction() const;
  /// Returns what the user is told of the pair: what is `shared` by both, and the impulses that the solver
  /// has found for its points, of which there are some.
  PairOverlap read(const Overlap& shared) const;
  /// Logs an error, once for each pair: a body that is lost stays lost.
  void logOnce(const std::string& message);

  // What is read for each pair in each step comes first: most pairs of a pile are idle.
  BodySnapshot* body_a = nullptr;  ///< null if the pair is in no table
  BodySnapshot* body_b = nullptr;
  std::uint64_t step = 0;    ///< of the last update that it was part of, or that came before it
  bool asked = false;        ///< by Bullet, since that
  bool published = false;    ///< in that update
  bool announced = false;    ///< Bullet has not asked for it yet
  bool busy = false;         ///< a thread is at work on it alone
  bool of_packings = false;  ///< two of them
  bool swapped = false;      ///< B is the first body for Bullet
  bool plain = false;        ///< no child of a compound
  btScalar separation = 0;   ///< asked for [m]
  SafeDistance safe;

  PairSide a, b;
  ContactOptions options;  ///< of the pair
  std::unique_ptr<FoundContact> found;
  ManifoldWriter manifolds;
  btScalar depth = 0;             ///< of the deepest contact; negative: of the gap [m]
  btScalar time_step = 0;         ///< of the last update [s]
  std::uint64_t pushed_step = 0;  ///< when penalty forces acted last
  PenaltyReport penalty;
  std::size_t list_index = 0;  ///< see PairList

 private:
  bool logged_ = false;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
