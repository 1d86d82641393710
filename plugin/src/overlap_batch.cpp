#include "overlap_batch.hpp"

#include <algorithm>

#include <tbb/parallel_for.h>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include "innersphere/error.hpp"
#include "measure.hpp"
#include "patch_builder.hpp"
#include "sweep.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

bool same(const btVector3& a, const btVector3& b) {
  return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
}

/// By how much spheres without volume-true radii are enlarged to fill their solid [m].
btScalar gapsOf(const PackingShape& shape, const Prefix& prefix) {
  return prefix.volume_true == nullptr ? prefix.recess() * shape.getLocalScaling().x() : btScalar(0);
}

struct Bodies {
  explicit Bodies(const PackingContact& contact)
      : a(*contact.a.shape, contact.a.transform, Estimator::raw, contact.measure->slack_a,
          contact.measure->prefix_a),
        b(*contact.b.shape, contact.b.transform, Estimator::raw, contact.measure->slack_b,
          contact.measure->prefix_b) {}
  PackingBody a;
  PackingBody b;
};

/// Keeps those of `contacts` that are candidates.
void keepCandidates(const std::vector<SphereContact>& contacts, std::size_t count_a,
                    PackingContact& contact) {
  constexpr std::size_t kNone = ~std::size_t(0);
  static thread_local std::vector<std::size_t> place;
  std::vector<std::size_t>& candidates = contact.memory.candidates.indices;
  place.assign(contacts.size(), kNone);
  for (std::size_t i : candidates) place[i] = 0;
  contact.contacts.clear();
  contact.count_a = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (place[i] == kNone) continue;
    place[i] = contact.contacts.size();
    contact.contacts.push_back(contacts[i]);
    if (i < count_a) ++contact.count_a;
  }
  for (std::size_t& i : candidates) i = place[i];
}

/// Whether surfaces are near each other at any of the candidates.
bool measureOnSurfaces(const Bodies& bodies, PackingContact& contact) {
  const PackingGauge gauge(bodies.a, bodies.b, contact.contacts, contact.count_a);
  return measurePatches(contact.memory.candidates, gauge, *contact.measure, contact.memory.patches);
}

}  // namespace

PackingSide::PackingSide(const btCollisionObjectWrapper& wrapper, const PackingShape& packing_shape)
    : object(wrapper.getCollisionObject()),
      shape(&packing_shape),
      transform(wrapper.getWorldTransform()),
      scaling(packing_shape.getLocalScaling()),
      margin(packing_shape.getMargin()),
      prefix(packing_shape.impl().prefix) {
  for (const btCollisionObjectWrapper* w = &wrapper; w->m_parent != nullptr; w = w->m_parent) {
    if (nesting == kMaxNesting) {
      nesting = -1;
      return;
    }
    child_of[nesting++] = w->m_index;
  }
}

bool PackingSide::isAlike(const PackingSide& other) const {
  return object == other.object && shape == other.shape && margin == other.margin && prefix == other.prefix &&
         same(scaling, other.scaling);
}

bool PackingSide::refresh() {
  if (nesting < 0) return false;
  const btCollisionShape* at = object->getCollisionShape();
  transform = object->getWorldTransform();
  for (int level = nesting - 1; level >= 0; --level) {
    if (!at->isCompound()) return false;
    const auto& compound = static_cast<const btCompoundShape&>(*at);
    if (child_of[level] < 0 || child_of[level] >= compound.getNumChildShapes()) return false;
    transform = transform * compound.getChildTransform(child_of[level]);
    at = compound.getChildShape(child_of[level]);
  }
  if (at != shape) return false;
  scaling = shape->getLocalScaling();
  margin = shape->getMargin();
  prefix = shape->impl().prefix;
  return isFinite(transform);
}

void OverlapBatch::setOptions(const ContactOptions& options) {
  const std::lock_guard<std::mutex> lock(mutex_);
  finishLaunch();
  if (options.backend != options_.backend) context_.reset();
  options_ = options;
  for (PackingContact* contact : live_) contact->valid = false;
}

void OverlapBatch::add(PackingContact* contact) {
  const std::lock_guard<std::mutex> lock(mutex_);
  live_.push_back(contact);
}

void OverlapBatch::remove(PackingContact* contact) {
  const std::lock_guard<std::mutex> lock(mutex_);
  finishLaunch();
  live_.erase(std::remove(live_.begin(), live_.end(), contact), live_.end());
}

const std::vector<ContactPatch>& OverlapBatch::update(PackingContact& contact, const PackingSide& a,
                                                      const PackingSide& b, btScalar separation) {
  const std::lock_guard<std::mutex> lock(mutex_);
  finishLaunch();
  if (contact.separation != separation) contact.valid = false;
  contact.separation = separation;
  const Age age = ageOf(contact, a, b);
  contact.a = a;
  contact.b = b;
  if (age == Age::current) {
    contact.memory.carryTo(contact.placed(), *a.shape, contact.measure->spacing);
  } else {
    contact.searching = age == Age::stale;
    stale_.assign(1, &contact);
    gatherStale(&contact);
    try {
      runStale();
    } catch (const Error&) {
      // Another pair may be at fault; it will hear of it when it is asked for.
      if (stale_.size() == 1) throw;
      stale_.assign(1, &contact);
      runStale();
    }
  }
  contact.wanted = true;
  return contact.memory.patches;
}

Overlap OverlapBatch::volumesOf(const PackingContact& contact) {
  const std::lock_guard<std::mutex> lock(mutex_);
  finishLaunch();
  if (contact.valid && !contact.measure->on_surfaces) return contact.overlap;
  return context().overlap(makeQuery(Pass::volumes, contact), {Want::wrench, options_.estimator});
}

QueryContext& OverlapBatch::context() {
  if (!context_) context_ = std::make_unique<QueryContext>(QueryContextOptions{options_.backend, 0});
  return *context_;
}

void OverlapBatch::launch(const std::vector<PackingContact*>& fresh) {
  const std::lock_guard<std::mutex> lock(mutex_);
  finishLaunch();
  for (PackingContact* contact : fresh) contact->wanted = true;
  stale_.clear();
  gatherStale(nullptr);
  if (stale_.empty()) return;
  prepareStale();
  makeQueries(Pass::surfaces);
  try {
    if (!queries_.empty()) context().start(queries_.data(), queries_.size(), optionsOf(Pass::surfaces));
    launched_ = true;
  } catch (const Error&) {
    // No context: each pair hears of it when it is asked for.
  }
}

void OverlapBatch::finishLaunch() {
  if (!launched_) return;
  launched_ = false;
  try {
    if (!queries_.empty()) {
      context().wait(result_);
      takeResults(Pass::surfaces);
    }
    runFurtherPasses();
  } catch (const Error&) {
    // All of them are invalid still, so that each is queried again when it is asked for.
  }
}

BatchCount OverlapBatch::count() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return count_;
}

OverlapBatch::Age OverlapBatch::ageOf(const PackingContact& contact, const PackingSide& a,
                                      const PackingSide& b) const {
  if (!contact.valid || !contact.a.isAlike(a) || !contact.b.isAlike(b)) return Age::stale;
  // Also if the bodies have become faster: contacts are wanted from further away then.
  const Measure& measure = *contact.measure;
  const Age age = contact.memory.ageAt({a.transform, b.transform}, a.shape->getAngularMotionDisc(),
                                       b.shape->getAngularMotionDisc(), neededSeparation(contact),
                                       measure.separation, measure.spacing);
  const bool same = contact.a.transform == a.transform && contact.b.transform == b.transform;
  const bool keeps = measure.on_surfaces && !contact.deep;
  return keeps || same ? age : Age::stale;
}

/// Appends all pairs but `asked`.
void OverlapBatch::gatherStale(const PackingContact* asked) {
  for (PackingContact* other : live_) {
    if (other == asked || !other->wanted) continue;
    if (!other->a.object->isActive() && !other->b.object->isActive()) continue;
    PackingSide a = other->a, b = other->b;
    if (!a.refresh() || !b.refresh()) continue;
    const Age age = ageOf(*other, a, b);
    if (age == Age::current) continue;
    other->searching = age == Age::stale;
    other->a = a;
    other->b = b;
    other->wanted = false;
    stale_.push_back(other);
  }
}

void OverlapBatch::prepareStale() {
  std::size_t searching = 0;
  for (PackingContact* contact : stale_) {
    contact->valid = false;
    if (!contact->searching) continue;
    contact->measure.emplace(measureOf(*contact));
    ++searching;
  }
  count_.launches += searching > 0 ? 1 : 0;
  count_.pairs += searching;
  count_.measured += stale_.size() - searching;
}

void OverlapBatch::runStale() {
  prepareStale();
  run(Pass::surfaces);
  runFurtherPasses();
}

void OverlapBatch::runFurtherPasses() {
  measureAgain();
  run(Pass::touch);
  run(Pass::deep);
  run(Pass::volumes);
}

void OverlapBatch::run(Pass pass) {
  makeQueries(pass);
  if (queries_.empty()) return;
  context().run(queries_.data(), queries_.size(), optionsOf(pass), result_);
  takeResults(pass);
}

void OverlapBatch::makeQueries(Pass pass) {
  queried_.clear();
  queries_.clear();
  for (PackingContact* contact : stale_) {
    if (!takesPart(pass, *contact)) continue;
    queried_.push_back(contact);
    queries_.push_back(makeQuery(pass, *contact));
  }
}

void OverlapBatch::takeResults(Pass pass) {
  // Each pair has its own result, so that their order does not matter.
  tbb::parallel_for(std::size_t(0), queried_.size(),
                    [&](std::size_t i) { takeResult(pass, i, *queried_[i]); });
}

bool OverlapBatch::takesPart(Pass pass, const PackingContact& contact) const {
  if (!contact.searching) return false;
  if (!contact.measure->on_surfaces) return pass == Pass::volumes;
  switch (pass) {
    case Pass::surfaces:
      return true;
    case Pass::touch:
      return contact.near && !contact.touching;
    case Pass::deep:
      return contact.deep;
    default:
      return false;
  }
}

QueryOptions OverlapBatch::optionsOf(Pass pass) const {
  switch (pass) {
    case Pass::surfaces:
      return {Want::contacts, Estimator::raw};
    case Pass::touch:
      return {Want::touch, Estimator::raw};
    case Pass::deep:
      return {Want::contacts, Estimator::volume_true};
    default:
      return {Want::contacts, options_.estimator};
  }
}

btScalar OverlapBatch::neededSeparation(const PackingContact& contact) const {
  return btMax(contact.separation, sweepOf(*contact.a.object, *contact.b.object, contact.time_step));
}

Measure OverlapBatch::measureOf(const PackingContact& contact) const {
  return Measure(options_, *contact.a.shape, *contact.b.shape, neededSeparation(contact));
}

PairQuery OverlapBatch::makeQuery(Pass pass, const PackingContact& contact) const {
  const Measure& measure = *contact.measure;
  PairQuery query;
  query.a = &contact.a.shape->model();
  query.b = &contact.b.shape->model();
  query.placement_a = PackingBody(*contact.a.shape, contact.a.transform, Estimator::raw, 0).placement();
  query.placement_b = PackingBody(*contact.b.shape, contact.b.transform, Estimator::raw, 0).placement();
  query.margin = contact.a.margin + contact.b.margin;
  query.prefix_a = static_cast<std::uint32_t>(measure.prefix_a->count);
  query.prefix_b = static_cast<std::uint32_t>(measure.prefix_b->count);
  if (pass == Pass::surfaces) query.margin += measure.slack();
  if (pass == Pass::deep) {
    query.margin += gapsOf(*contact.a.shape, *measure.prefix_a) + gapsOf(*contact.b.shape, *measure.prefix_b);
  }
  return query;
}

void OverlapBatch::takeResult(Pass pass, std::size_t index, PackingContact& contact) const {
  static thread_local std::vector<SphereContact> contacts;
  if (pass == Pass::touch) {
    contact.deep = result_.overlaps[index].pair_count > 0;
    return;
  }
  // Every lens belongs to a sphere of A and to one of B: both lists together have all of it twice.
  contacts.clear();
  const auto append = [&](const QueryResult::Ranges<SphereContact>& ranges) {
    for (std::size_t k = ranges.first[index]; k < ranges.first[index + 1]; ++k) {
      SphereContact half = ranges.items[k];
      half.volume /= 2;
      for (float& component : half.area) component /= 2;
      contacts.push_back(half);
    }
  };
  append(result_.contacts_a);
  const std::size_t count_a = contacts.size();
  append(result_.contacts_b);

  const Measure& measure = *contact.measure;
  const btMatrix3x3& reference = contact.a.transform.getBasis();
  ContactMemory& memory = contact.memory;
  if (pass == Pass::surfaces) {
    const Bodies bodies(contact);
    findCandidates(contacts, PackingGauge(bodies.a, bodies.b, contacts, count_a), measure.spacing, reference,
                   memory.patches, memory.candidates);
    keepCandidates(contacts, count_a, contact);
    contact.near = !contacts.empty();
    contact.touching = measureOnSurfaces(bodies, contact);
    contact.deep = false;
  } else if (pass == Pass::deep) {
    gradientPatch(contacts, measure.spacing, reference, memory.patches);
  } else {
    volumePatches(contacts, measure.spacing, reference, memory.patches);
    contact.overlap = result_.overlaps[index];
  }
  memory.searchedAt(contact.placed());
  memory.measuredAt(contact.placed());
  contact.valid = true;
}

/// Those that moved too little for a query.
void OverlapBatch::measureAgain() {
  tbb::parallel_for(std::size_t(0), stale_.size(), [&](std::size_t i) {
    PackingContact& contact = *stale_[i];
    if (contact.searching) return;
    contact.memory.turnTo(contact.placed());
    contact.touching = measureOnSurfaces(Bodies(contact), contact);
    contact.memory.measuredAt(contact.placed());
    contact.valid = true;
  });
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
