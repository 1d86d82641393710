#include "overlap_batch.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "in_parallel.hpp"
#include "innersphere/error.hpp"
#include "measure.hpp"
#include "patch_builder.hpp"
#include "sweep.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// By how much spheres without volume-true radii are enlarged to fill their solid [m].
btScalar gapsOf(const PackingShape& shape, const Prefix& prefix) {
  return prefix.volume_true == nullptr ? prefix.recess() * shape.getLocalScaling().x() : btScalar(0);
}

struct Bodies {
  explicit Bodies(const PackingContact& contact)
      : a(*contact.a.packing, contact.a.transform, Estimator::raw, contact.measure->slack_a,
          contact.measure->prefix_a),
        b(*contact.b.packing, contact.b.transform, Estimator::raw, contact.measure->slack_b,
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

void OverlapBatch::setOptions(const ContactOptions& options) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLaunch();
  if (options.backend != options_.backend) context_.reset();
  options_ = options;
  live_.forEach([](PackingContact& contact) {
    contact.valid = false;
    contact.look->reset();
  });
}

void OverlapBatch::add(PackingContact* contact) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  contact->look = looks_.add(contact->a, contact->b);
  live_.add(contact);
  // Any number of them may turn stale in one step, which should not allocate then.
  stale_.reserve(live_.capacity());
  queried_.reserve(live_.capacity());
  queries_.reserve(live_.capacity());
}

void OverlapBatch::remove(PackingContact* contact) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLaunch();
  looks_.remove(contact->look);
  contact->look = &contact->own_look;
  live_.remove(contact);
}

bool OverlapBatch::hasDelivered(PackingContact& contact, const btCollisionObjectWrapper& a,
                                const btCollisionObjectWrapper& b, btScalar separation) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLaunch();
  LookBoard::follow(*contact.look, contact.a, contact.b);
  if (contact.separation != separation || contact.a.nesting < 0 || contact.b.nesting < 0) return false;
  const auto isHere = [&] { return contact.a.isWhere(a) && contact.b.isWhere(b); };
  if (!isHere()) {
    if (!looks_.isDue(*contact.look)) return false;
    bringUpToDate(contact.time_step);
    if (!isHere()) return false;
  }
  if (!contact.look->received || !contact.valid || !looks_.isFresh(*contact.look) ||
      !contact.a.isUpToDate() || !contact.b.isUpToDate() || neededSeparation(contact) > contact.needed)
    return false;
  looks_.ask(*contact.look);
  return true;
}

const std::vector<ContactPatch>& OverlapBatch::update(PackingContact& contact, const PackingSide& a,
                                                      const PackingSide& b, btScalar separation) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLaunch();
  LookBoard::follow(*contact.look, contact.a, contact.b);
  if (contact.separation != separation) contact.valid = false;
  contact.separation = separation;
  const bool moved = !a.isWhere(contact.a) || !b.isWhere(contact.b);
  if (moved && looks_.isDue(*contact.look)) bringUpToDate(contact.time_step);
  if (!isUpToDate(contact, a, b)) updateAlone(contact, a, b);
  looks_.ask(*contact.look);
  return contact.memory.patches;
}

Overlap OverlapBatch::volumesOf(PackingContact& contact) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLaunch();
  LookBoard::follow(*contact.look, contact.a, contact.b);
  if (contact.valid && !contact.measure->on_surfaces) return contact.overlap;
  return context().overlap(makeQuery(Pass::volumes, contact), {Want::wrench, options_.estimator});
}

QueryContext& OverlapBatch::context() {
  if (!context_) context_ = std::make_unique<QueryContext>(QueryContextOptions{options_.backend, 0});
  return *context_;
}

void OverlapBatch::launch(const std::vector<PackingContact*>& fresh, btScalar time_step) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLaunch();
  for (PackingContact* contact : fresh) looks_.ask(*contact->look);
  lookAtAll(time_step);
  if (stale_.empty()) return;
  try {
    startStale();
    launched_ = true;
  } catch (const Error&) {
    // No context: each pair hears of it when it is asked for.
  }
}

void OverlapBatch::finish() {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLaunch();
}

void OverlapBatch::finishLaunch() {
  if (!launched_) return;
  launched_ = false;
  try {
    finishStale();
  } catch (const Error&) {
    // All of them are invalid still, so that each is queried again when it is asked for.
  }
  deliver();
}

BatchCount OverlapBatch::count() const {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  return count_;
}

OverlapBatch::Age OverlapBatch::ageOf(const PackingContact& contact, const PackingSide& a,
                                      const PackingSide& b) const {
  if (!contact.valid || !contact.a.isAlike(a) || !contact.b.isAlike(b)) return Age::stale;
  // Also if the bodies have become faster: contacts are wanted from further away then.
  const Measure& measure = *contact.measure;
  const bool empty = contact.memory.candidates.indices.empty();
  const Age age = contact.memory.ageAt({a.transform, b.transform}, a.packing->getAngularMotionDisc(),
                                       b.packing->getAngularMotionDisc(), contact.needed, measure.separation,
                                       measure.spacing, empty);
  const bool same = contact.a.transform == a.transform && contact.b.transform == b.transform;
  const bool keeps = measure.on_surfaces && !contact.deep;
  return keeps || same ? age : Age::stale;
}

bool OverlapBatch::isUpToDate(const PackingContact& contact, const PackingSide& a,
                              const PackingSide& b) const {
  return contact.valid && looks_.isFresh(*contact.look) && contact.a.isAlike(a) && contact.b.isAlike(b) &&
         contact.a.isWhere(a) && contact.b.isWhere(b) && !(neededSeparation(contact) > contact.needed);
}

void OverlapBatch::bringUpToDate(btScalar time_step) {
  lookAtAll(time_step);
  try {
    runStale();
  } catch (const Error&) {
    // Another pair may be at fault; it will hear of it when it is asked for.
  }
  deliver();
}

/// What the stale pairs of a look have got.
void OverlapBatch::deliver() {
  inParallel(stale_.size(), [&](std::size_t i) { handOut(*stale_[i]); });
}

void OverlapBatch::handOut(PackingContact& contact) const {
  Look& look = *contact.look;
  if (!contact.valid || !looks_.isFresh(look)) return;
  look.received = contact.separation == 0 &&
                  contact.receiver.receive(contact.memory.patches, options_, contact.time_step);
  const Measure& measure = *contact.measure;
  if (!look.received || !measure.on_surfaces || contact.deep) return;
  const btScalar leeway = contact.memory.leeway(contact.placed(), contact.a.packing->getAngularMotionDisc(),
                                                contact.b.packing->getAngularMotionDisc(), measure.spacing);
  looks_.calm(look, leeway, measure.separation - ContactMemory::reserve(measure.spacing));
}

void OverlapBatch::lookAtAll(btScalar time_step) {
  looks_.begin(time_step);
  std::atomic<std::size_t> count{0};
  stale_.resize(live_.size());
  const auto look = [&](PackingContact& contact) {
    if (!looks_.join(*contact.look) || looks_.staysCalm(*contact.look)) return;
    if (!lookAt(contact, time_step)) stale_[count++] = &contact;
  };
  live_.forEachInParallel(look, fetchLook<PackingContact>);
  stale_.resize(count);
  // In their own order, whichever thread came first.
  std::sort(stale_.begin(), stale_.end(), [](const PackingContact* one, const PackingContact* other) {
    return one->list_index < other->list_index;
  });
}

/// Finds out what there is to do for a pair, and does it if it is only to take its contacts along. False if
/// there is more to do.
bool OverlapBatch::lookAt(PackingContact& contact, btScalar time_step) const {
  if (!isActive(contact.a, contact.b)) return true;
  PackingSide a = contact.a, b = contact.b;
  if (!a.refresh() || !b.refresh()) return true;
  contact.look->wanted = false;
  contact.time_step = time_step;
  place(contact, a, b);
  if (contact.age != Age::current) return false;
  handOut(contact);
  return true;
}

void OverlapBatch::place(PackingContact& contact, const PackingSide& a, const PackingSide& b) const {
  contact.look->reset();
  contact.needed = neededSeparation(contact);
  contact.age = ageOf(contact, a, b);
  contact.a = a;
  contact.b = b;
  if (contact.age == Age::current) {
    contact.memory.carryTo(contact.placed(), *a.packing, contact.measure->spacing);
    return;
  }
  contact.valid = false;
  if (contact.age == Age::stale) contact.measure.emplace(options_, *a.packing, *b.packing, contact.needed);
}

void OverlapBatch::updateAlone(PackingContact& contact, const PackingSide& a, const PackingSide& b) {
  place(contact, a, b);
  if (contact.age == Age::current) return;
  stale_.assign(1, &contact);
  runStale();
}

void OverlapBatch::countStale() {
  const auto searching = static_cast<std::size_t>(std::count_if(
      stale_.begin(), stale_.end(), [](const PackingContact* c) { return c->age == Age::stale; }));
  count_.launches += searching > 0 ? 1 : 0;
  count_.pairs += searching;
  count_.measured += stale_.size() - searching;
}

void OverlapBatch::runStale() {
  startStale();
  finishStale();
}

void OverlapBatch::startStale() {
  countStale();
  makeQueries(Pass::surfaces);
  if (!queries_.empty()) context().start(queries_.data(), queries_.size(), optionsOf(Pass::surfaces));
}

void OverlapBatch::finishStale() {
  measureAgain();  // while a device works
  if (!queries_.empty()) {
    context().wait(result_);
    takeResults(Pass::surfaces);
  }
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
  for (PackingContact* contact : stale_) {
    if (takesPart(pass, *contact)) queried_.push_back(contact);
  }
  queries_.resize(queried_.size());
  inParallel(queried_.size(), [&](std::size_t i) { queries_[i] = makeQuery(pass, *queried_[i]); });
}

void OverlapBatch::takeResults(Pass pass) {
  // Each pair has its own result, so that their order does not matter.
  inParallel(queried_.size(), [&](std::size_t i) { takeResult(pass, i, *queried_[i]); });
}

bool OverlapBatch::takesPart(Pass pass, const PackingContact& contact) const {
  if (contact.age != Age::stale) return false;
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

PairQuery OverlapBatch::makeQuery(Pass pass, const PackingContact& contact) const {
  const Measure& measure = *contact.measure;
  PairQuery query;
  query.a = &contact.a.packing->model();
  query.b = &contact.b.packing->model();
  query.placement_a = PackingBody(*contact.a.packing, contact.a.transform, Estimator::raw, 0).placement();
  query.placement_b = PackingBody(*contact.b.packing, contact.b.transform, Estimator::raw, 0).placement();
  query.margin = contact.a.margin + contact.b.margin;
  query.prefix_a = static_cast<std::uint32_t>(measure.prefix_a->count);
  query.prefix_b = static_cast<std::uint32_t>(measure.prefix_b->count);
  if (pass == Pass::surfaces) query.margin += measure.slack();
  if (pass == Pass::deep) {
    query.margin +=
        gapsOf(*contact.a.packing, *measure.prefix_a) + gapsOf(*contact.b.packing, *measure.prefix_b);
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
  memory.measuredAt(contact.placed(), measure.separation);
  contact.valid = true;
}

/// Those that moved too little for a query.
void OverlapBatch::measureAgain() {
  inParallel(stale_.size(), [&](std::size_t i) {
    PackingContact& contact = *stale_[i];
    if (contact.age == Age::stale) return;
    contact.memory.turnTo(contact.placed());
    contact.touching = measureOnSurfaces(Bodies(contact), contact);
    contact.memory.measuredAt(contact.placed(), contact.measure->separation);
    contact.valid = true;
  });
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
