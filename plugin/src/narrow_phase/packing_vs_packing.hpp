// Finds the contact of two packings.
#pragma once

#include <cstdint>
#include <vector>

#include "innersphere/contact_options.hpp"
#include "innersphere/query.hpp"
#include "narrow_phase/found_contact.hpp"
#include "narrow_phase/sweep.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Names a pass of a search. A search takes up to four passes, each a query that many pairs can share; the
/// result of one tells whether there is another.
enum class SearchPass : std::uint8_t {
  none,      ///< the search is over
  surfaces,  ///< with spheres enlarged so that they find all contact of the surfaces that they stand for;
             ///< once for each pose of a pair that is swept
  nearby,    ///< the same with spheres enlarged by no more than half the thickness of the solids, where those
             ///< of `surfaces` are larger: they meet all sides of what is thin, and do not tell the near one
  touch,     ///< with spheres as they are, where the surfaces showed no overlap, or push against each other:
             ///< it may be too deep
  deep,      ///< with spheres enlarged so that they fill their solids, where it is: for the way out
  volumes,   ///< where the volume of overlap is all that is wanted
};

/// Returns what the query of a pass computes. `estimator` is that of the options, for volumes.
QueryOptions queryOptionsOf(SearchPass pass, Estimator estimator);

/// Holds the contact of two packings, which must outlive it.
class PackingVsPacking : public FoundContact {
 public:
  PackingVsPacking(const PackingShape& a, const PackingShape& b) : a_(&a), b_(&b) {}

  /// Begins a search and returns its first pass. It looks for contacts up to `step.needed` apart. Until the
  /// last pass is over, the contact is not known.
  SearchPass begin(const ContactOptions& options, const Placed& now, const StepAhead& step);
  /// Returns the query of a pass.
  PairQuery makeQuery(SearchPass pass) const;
  /// Takes the result number `index` and returns the next pass.
  SearchPass take(SearchPass pass, const QueryResult& result, std::size_t index);

  bool refine(const Placed& now, const StepAhead& step) override;
  const Overlap* overlap() const override {
    return isKnown() && !settings->on_surfaces ? &overlap_ : nullptr;
  }
  /// Returns the query for the volume that both share at `now`.
  PairQuery makeVolumeQuery(const ContactOptions& options, const Placed& now) const;

 private:
  struct Bodies;
  bool evaluateDepths(const Bodies& bodies);
  PairQuery makeQuery(SearchPass pass, const ContactSettings& measure, const Placed& now) const;
  btScalar halfThickness() const;
  bool reachesFar() const;
  bool pushesEachWay() const;
  void selectMoreSamples(const Bodies& bodies, const std::vector<SphereContact>& contacts,
                         std::size_t count_a);

  const PackingShape* a_;
  const PackingShape* b_;
  Placed now_;
  StepAhead step_;
  Sweep sweep_;
  std::optional<ContactSettings> search_;  ///< settings of a search that is under way
  std::vector<SphereContact> contacts_;    ///< the samples
  std::size_t count_a_ = 0;                ///< of A's spheres, which come first
  btVector3 way_out_{0, 0, 0};             ///< of bodies deep in each other, in the last search [m]
  Overlap overlap_;                        ///< only where depth is not measured on the surfaces
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
