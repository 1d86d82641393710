// All pairs of a packing and a shape of another kind of one dispatcher, brought up to date together.
#pragma once

#include <optional>
#include <vector>

#include "innersphere/contact_options.hpp"
#include "narrow_phase/packing_vs_shape.hpp"
#include "pair_cache/body_side.hpp"
#include "pair_cache/contact_receiver.hpp"
#include "pair_cache/look_board.hpp"
#include "pair_cache/pair_list.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

struct SurfacePair : ListedPair {
  SurfacePair(const PackingSide& packing, const BodySide& other, ContactReceiver& where_to)
      : receiver(where_to), a(packing), b(other), contact(*packing.packing, *other.shape) {}

  ContactReceiver& receiver;
  Look own_look;
  Look* look = &own_look;           ///< the board's once it has been added
  btScalar separation = 0;          ///< asked for [m]
  std::optional<btScalar> reached;  ///< contacts are right for gaps up to this [m], if they are at all
  PackingSide a;
  BodySide b;
  SurfaceContact contact;
};

/// Looks at all pairs at once, with all threads: see LookBoard. Safe to use from several threads at once.
class SurfaceBatch {
 public:
  void setOptions(const ContactOptions& options);

  void add(SurfacePair* pair);
  void remove(SurfacePair* pair);

  /// True if the last look, or one that is due now, has handed out the patches of `pair` for two bodies as
  /// they are now: then there is nothing left to do.
  bool hasDelivered(SurfacePair& pair, const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                    btScalar separation, btScalar time_step);

  /// Looks at all pairs now that will be asked for in this step: those that were in the step before.
  void launch(btScalar time_step);

  /// Brings `pair` up to date for two sides and returns its patches: also those of contacts up to
  /// `separation` [m] apart, or that may close within `time_step` [s]. It need not have been added.
  const std::vector<ContactPatch>& update(SurfacePair& pair, const PackingSide& a, const BodySide& b,
                                          btScalar separation, btScalar time_step);
  /// What both share, as they were in the last update. Its torque is about the origin of the packing.
  Overlap volumesOf(SurfacePair& pair);

  /// What tells whether there is anything to do for a pair.
  LookBoard& looks() { return looks_; }

 private:
  void lookAtAll(btScalar time_step);
  void lookAt(SurfacePair& pair, btScalar time_step) const;
  void place(SurfacePair& pair, const PackingSide& a, const BodySide& b, btScalar time_step) const;

  ContactOptions options_;
  LookBoard looks_;
  PairList<SurfacePair> live_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
