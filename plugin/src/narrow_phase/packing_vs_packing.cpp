#include "narrow_phase/packing_vs_packing.hpp"

#include "common/contact_tolerances.hpp"
#include "narrow_phase/contact_patches.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

bool isOfSurfaces(SearchPass pass) {
  return pass == SearchPass::surfaces || pass == SearchPass::nearby;
}

/// In halves of the thickness: from here on lines through bodies may meet other sides of them.
constexpr btScalar kDeep = btScalar(0.5);

/// By how much spheres without volume-true radii are enlarged to fill their solid [m].
btScalar gapsOf(const PackingShape& shape, const Prefix& prefix) {
  return prefix.volume_true == nullptr ? prefix.inset() * shape.getLocalScaling().x() : btScalar(0);
}

/// Keeps those of `contacts` that are samples. `count_a`: those of A come first, before and after.
void keepSamples(const std::vector<SphereContact>& contacts, std::size_t count_a, Samples& samples,
                 std::vector<SphereContact>& kept, std::size_t& kept_a) {
  constexpr std::size_t kNone = ~std::size_t(0);
  static thread_local std::vector<std::size_t> place;
  place.assign(contacts.size(), kNone);
  for (std::size_t i : samples.indices) place[i] = 0;
  kept.clear();
  kept_a = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (place[i] == kNone) continue;
    place[i] = kept.size();
    kept.push_back(contacts[i]);
    if (i < count_a) ++kept_a;
  }
  for (std::size_t& i : samples.indices) i = place[i];
}

/// Appends result number `index`. Every lens belongs to a sphere of A and to one of B: both lists together
/// would have all of it twice.
void appendHalves(const QueryResult::Ranges<SphereContact>& ranges, std::size_t index,
                  std::vector<SphereContact>& contacts) {
  for (std::size_t k = ranges.first[index]; k < ranges.first[index + 1]; ++k) {
    SphereContact half = ranges.items[k];
    half.volume /= 2;
    for (float& component : half.area) component /= 2;
    contacts.push_back(half);
  }
}

}  // namespace

struct PackingVsPacking::Bodies {
  Bodies(const PackingVsPacking& pair, const ContactSettings& measure)
      : a(*pair.a_, pair.now_.a, Estimator::raw, measure.search_margin_a, measure.prefix_a),
        b(*pair.b_, pair.now_.b, Estimator::raw, measure.search_margin_b, measure.prefix_b) {
    a.addSearchFeelers();
    b.addSearchFeelers();
  }
  PlacedPacking a;
  PlacedPacking b;
};

QueryOptions queryOptionsOf(SearchPass pass, Estimator estimator) {
  switch (pass) {
    case SearchPass::surfaces:
    case SearchPass::nearby:
      return {Want::contacts, Estimator::raw, false};
    case SearchPass::touch:
      return {Want::touch, Estimator::raw};
    case SearchPass::deep:
      return {Want::contacts, Estimator::volume_true, false};
    default:
      return {Want::contacts, estimator};
  }
}

SearchPass PackingVsPacking::begin(const ContactOptions& options, const Placed& now, const StepAhead& step) {
  forget();
  sweep_ = Sweep(*a_, *b_, now, step);
  now_ = now;
  step_ = sweep_.ahead();
  search_.emplace(options, *a_, *b_, step_.needed);
  return search_->on_surfaces ? SearchPass::surfaces : SearchPass::volumes;
}

PairQuery PackingVsPacking::makeQuery(SearchPass pass) const {
  return makeQuery(pass, *search_, now_);
}

PairQuery PackingVsPacking::makeVolumeQuery(const ContactOptions& options, const Placed& now) const {
  return makeQuery(SearchPass::volumes, ContactSettings(options, *a_, *b_, 0), now);
}

PairQuery PackingVsPacking::makeQuery(SearchPass pass, const ContactSettings& measure,
                                      const Placed& now) const {
  PairQuery query;
  query.a = &a_->model();
  query.b = &b_->model();
  query.placement_a = PlacedPacking(*a_, now.a, Estimator::raw, 0).placement();
  query.placement_b = PlacedPacking(*b_, now.b, Estimator::raw, 0).placement();
  query.margin = a_->getMargin() + b_->getMargin();
  query.prefix_a = static_cast<std::uint32_t>(measure.prefix_a->count);
  query.prefix_b = static_cast<std::uint32_t>(measure.prefix_b->count);
  if (isOfSurfaces(pass)) {
    query.a = &measure.prefix_a->searchModel();
    query.b = &measure.prefix_b->searchModel();
    query.prefix_a = query.prefix_b = 0;  // all
    query.margin += pass == SearchPass::nearby ? halfThickness() : measure.separation;
  }
  if (pass == SearchPass::deep)
    query.margin += gapsOf(*a_, *measure.prefix_a) + gapsOf(*b_, *measure.prefix_b);
  return query;
}

SearchPass PackingVsPacking::take(SearchPass pass, const QueryResult& result, std::size_t index) {
  static thread_local std::vector<SphereContact> contacts;
  if (pass == SearchPass::touch) {
    if (result.overlaps[index].pair_count > 0) return SearchPass::deep;
    way_out_.setZero();
    settings = search_;
    return SearchPass::none;
  }
  contacts.clear();
  appendHalves(result.contacts_a, index, contacts);
  const std::size_t count_a = contacts.size();
  appendHalves(result.contacts_b, index, contacts);

  const btMatrix3x3& reference = now_.a.getBasis();
  SearchPass next = SearchPass::none;
  if (isOfSurfaces(pass)) {
    const Bodies bodies(*this, *search_);
    if (pass == SearchPass::surfaces) {
      selectSamples(contacts, PackingProbe(bodies.a, bodies.b, contacts, count_a), reference, memory.patches,
                    memory.samples);
      keepSamples(contacts, count_a, memory.samples, contacts_, count_a_);
      releaseIfEmpty(contacts_);
      if (!contacts.empty() && reachesFar()) return SearchPass::nearby;
    } else {
      selectMoreSamples(bodies, contacts, count_a);
    }
    const bool near = evaluateDepths(bodies);
    if (sweep_.goesOn(memory.patches)) {
      now_ = sweep_.placed();
      step_ = sweep_.ahead();
      return SearchPass::surfaces;
    }
    if (!contacts.empty() && !sweep_.hasKept() && (!near || pushesEachWay())) next = SearchPass::touch;
    if (next == SearchPass::none) way_out_.setZero();
  } else if (pass == SearchPass::deep) {
    const Bodies bodies(*this, *search_);
    const PackingProbe spheres(bodies.a, bodies.b, contacts, count_a);
    wayOutPatch({bodies.a, bodies.b, contacts, spheres}, way_out_, search_->spacing, step_, memory.patches);
    way_out_ =
        memory.patches.empty() ? btVector3(0, 0, 0) : memory.patches[0].normal * memory.patches[0].depth();
  } else {
    volumePatches(contacts, search_->spacing, reference, memory.patches);
    overlap_ = result.overlaps[index];
  }
  on_surfaces = isOfSurfaces(pass);
  memory.noteSearch(now_);
  memory.noteDepths(now_, search_->separation);
  sweep_.finish(memory.patches);
  if (next == SearchPass::none) settings = search_;
  return next;
}

bool PackingVsPacking::refine(const Placed& now, const StepAhead& step) {
  now_ = now;
  step_ = step;
  memory.turnTo(now);
  search_ = settings;
  evaluateDepths(Bodies(*this, *settings));
  memory.noteDepths(now, settings->separation);
  return true;
}

/// Of the thinner one.
btScalar PackingVsPacking::halfThickness() const {
  return btMin(a_->impl().halfThickness(), b_->impl().halfThickness());
}

/// Whether spheres are enlarged so much that they meet all sides of what is thin. Pairs that are swept look
/// around at many poses instead.
bool PackingVsPacking::reachesFar() const {
  return !step_.motion.isSwept() && search_->separation > halfThickness();
}

/// Whether patches of several directions are so deep that lines through the bodies may meet other sides of
/// them: each may be the way out, and they push against each other.
bool PackingVsPacking::pushesEachWay() const {
  if (step_.motion.isSwept()) return false;
  const btScalar deep = kDeep * halfThickness();
  const ContactPatch* first = nullptr;
  for (const ContactPatch& patch : memory.patches) {
    if (!(patch.depth() > deep)) continue;
    if (first == nullptr) first = &patch;
    if (patch.normal.dot(first->normal) < kPatchCosine) return true;
  }
  return false;
}

/// Adds samples to those that there are. Of `contacts`, too, the first are A's.
void PackingVsPacking::selectMoreSamples(const Bodies& bodies, const std::vector<SphereContact>& contacts,
                                         std::size_t count_a) {
  static thread_local Samples more;
  static thread_local std::vector<SphereContact> kept;
  std::size_t kept_a = 0;
  selectSamples(contacts, PackingProbe(bodies.a, bodies.b, contacts, count_a), now_.a.getBasis(),
                memory.patches, more);
  keepSamples(contacts, count_a, more, kept, kept_a);

  Samples& all = memory.samples;
  const std::size_t before = contacts_.size(), before_a = count_a_, first = all.indices.size();
  const auto kept_b = kept.begin() + std::ptrdiff_t(kept_a);
  contacts_.insert(contacts_.begin() + std::ptrdiff_t(before_a), kept.begin(), kept_b);
  contacts_.insert(contacts_.end(), kept_b, kept.end());
  count_a_ += kept_a;
  for (std::size_t& i : all.indices) i += i < before_a ? 0 : kept_a;
  for (const std::size_t i : more.indices) all.indices.push_back(i + (i < kept_a ? before_a : before));
  for (Samples::OfPatch patch : more.patches) {
    patch.end += first;
    all.patches.push_back(patch);
  }
}

/// Whether surfaces are near each other at any of the samples.
bool PackingVsPacking::evaluateDepths(const Bodies& bodies) {
  const btScalar foretold = reachesFar() ? search_->separation : btScalar(0);
  const PackingProbe probe(bodies.a, bodies.b, contacts_, count_a_, search_->thin, foretold);
  memory.carryTo(now_, *a_, search_->spacing);
  return refinePatches(memory.samples, probe, *search_, step_, memory.patches);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
