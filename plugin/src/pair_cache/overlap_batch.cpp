#include "pair_cache/overlap_batch.hpp"

#include <atomic>
#include <mutex>

#include "common/motion_bound.hpp"
#include "common/parallel.hpp"
#include "innersphere/error.hpp"
#include "narrow_phase/contact_patches.hpp"
#include "narrow_phase/contact_settings.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// By how much spheres without volume-true radii are enlarged to fill their solid [m].
btScalar gapsOf(const PackingShape& shape, const Prefix& prefix) {
  return prefix.volume_true == nullptr ? prefix.inset() * shape.getLocalScaling().x() : btScalar(0);
}

struct Bodies {
  explicit Bodies(const PackingContact& contact)
      : a(*contact.a.packing, contact.a.transform, Estimator::raw, contact.measure->search_margin_a,
          contact.measure->prefix_a),
        b(*contact.b.packing, contact.b.transform, Estimator::raw, contact.measure->search_margin_b,
          contact.measure->prefix_b) {}
  PlacedPacking a;
  PlacedPacking b;
};

/// Keeps those of `contacts` that are samples.
void keepSamples(const std::vector<SphereContact>& contacts, std::size_t count_a, PackingContact& contact) {
  constexpr std::size_t kNone = ~std::size_t(0);
  static thread_local std::vector<std::size_t> place;
  std::vector<std::size_t>& samples = contact.memory.samples.indices;
  place.assign(contacts.size(), kNone);
  for (std::size_t i : samples) place[i] = 0;
  contact.contacts.clear();
  contact.count_a = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (place[i] == kNone) continue;
    place[i] = contact.contacts.size();
    contact.contacts.push_back(contacts[i]);
    if (i < count_a) ++contact.count_a;
  }
  for (std::size_t& i : samples) i = place[i];
}

/// Whether surfaces are near each other at any of the samples.
bool measureOnSurfaces(const Bodies& bodies, PackingContact& contact) {
  const PackingProbe probe(bodies.a, bodies.b, contact.contacts, contact.count_a);
  return refinePatches(contact.memory.samples, probe, *contact.measure, contact.memory.patches);
}

}  // namespace

void OverlapBatch::setOptions(const ContactOptions& options) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLook();
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
  // There may be something to do for any number of them in one step, which should not allocate then.
  tasks_.reserve(live_.capacity());
  work_.reserve(live_.capacity());
  searches_.reserve(live_.capacity());
  queried_.reserve(live_.capacity());
  queries_.reserve(live_.capacity());
}

void OverlapBatch::remove(PackingContact* contact) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLook();
  looks_.remove(contact->look);
  contact->look = &contact->own_look;
  live_.remove(contact);
}

bool OverlapBatch::hasDelivered(PackingContact& contact, const btCollisionObjectWrapper& a,
                                const btCollisionObjectWrapper& b, btScalar separation) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLook();
  LookBoard::follow(*contact.look, contact.a, contact.b);
  if (contact.separation != separation || contact.a.nesting < 0 || contact.b.nesting < 0) return false;
  const auto isHere = [&] { return contact.a.isWhere(a) && contact.b.isWhere(b); };
  if (!isHere()) {
    if (!looks_.isDue(*contact.look)) return false;
    lookAtAll(contact.time_step);
    finishLook();
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
  finishLook();
  LookBoard::follow(*contact.look, contact.a, contact.b);
  if (contact.separation != separation) contact.valid = false;
  contact.separation = separation;
  const bool moved = !a.isWhere(contact.a) || !b.isWhere(contact.b);
  if (moved && looks_.isDue(*contact.look)) {
    lookAtAll(contact.time_step);
    finishLook();
  }
  if (!isUpToDate(contact, a, b)) updateAlone(contact, a, b);
  looks_.ask(*contact.look);
  return contact.memory.patches;
}

Overlap OverlapBatch::volumesOf(PackingContact& contact) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLook();
  LookBoard::follow(*contact.look, contact.a, contact.b);
  if (contact.valid && !contact.measure->on_surfaces) return contact.overlap;
  return context().overlap(makeQuery(Task::volumes, contact), {Want::wrench, options_.estimator});
}

QueryContext& OverlapBatch::context() {
  if (!context_) context_ = std::make_unique<QueryContext>(QueryContextOptions{options_.backend, 0});
  return *context_;
}

void OverlapBatch::launch(const std::vector<PackingContact*>& fresh, btScalar time_step) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLook();
  for (PackingContact* contact : fresh) looks_.ask(*contact->look);
  lookAtAll(time_step);
}

void OverlapBatch::finish() {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  finishLook();
}

BatchCount OverlapBatch::count() const {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  return count_;
}

OverlapBatch::Age OverlapBatch::ageOf(const PackingContact& contact, const PackingSide& a,
                                      const PackingSide& b) const {
  if (!contact.valid || !contact.a.isAlike(a) || !contact.b.isAlike(b)) return Age::stale;
  // Also if the bodies have become faster: contacts are wanted from further away then.
  const ContactSettings& measure = *contact.measure;
  const bool empty = contact.memory.samples.indices.empty();
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

void OverlapBatch::lookAtAll(btScalar time_step) {
  looks_.begin(time_step);
  tasks_.assign(live_.size(), Task::nothing);
  const auto look = [&](PackingContact& contact) {
    if (!looks_.join(*contact.look) || looks_.staysCalm(*contact.look)) return;
    tasks_[contact.list_index] = lookAt(contact, time_step);
  };
  live_.forEachInParallel(look, fetchLook<PackingContact>, fetchUnlessCalm<PackingContact>);
  work_.clear();
  searches_.clear();
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    if (tasks_[i] != Task::nothing) jobsLike(tasks_[i]).push_back({live_.at(i), tasks_[i]});
  }
  under_way_ = true;
  const auto search = [&](const std::atomic<bool>& working) {
    try {
      startQueries();
      // A device goes on to its next step when it is asked whether it is done.
      while (working && !queries_.empty()) {
        if (context().ready()) takeStarted(true);
      }
    } catch (const Error&) {
      // Each pair hears of it when it is asked for: what was to be searched is invalid still.
      queries_.clear();
    }
  };
  const auto work = [&](std::size_t i) {
    workWithoutQuery(*work_[i].contact, work_[i].task);
    handOut(*work_[i].contact);
  };
  const auto fetchContact = [&](std::size_t i) { fetch(work_[i].contact); };
  const auto fetchPatches = [&](std::size_t i) {
    work_[i].contact->memory.fetchPatches();
    work_[i].contact->receiver.fetchManifolds();
  };
  inParallelBeside(search, work_.size(), work, fetchContact, fetchPatches);
}

void OverlapBatch::finishLook() {
  if (!under_way_) return;
  under_way_ = false;
  try {
    finishQueries(true);
  } catch (const Error&) {
    // As before; another pair may be at fault.
  }
}

/// Finds out what there is to do for a pair.
OverlapBatch::Task OverlapBatch::lookAt(PackingContact& contact, btScalar time_step) const {
  if (!isActive(contact.a, contact.b)) return Task::nothing;
  PackingSide a = contact.a, b = contact.b;
  if (!a.refresh() || !b.refresh()) return Task::nothing;
  contact.look->wanted = false;
  contact.time_step = time_step;
  return place(contact, a, b);
}

OverlapBatch::Task OverlapBatch::place(PackingContact& contact, const PackingSide& a,
                                       const PackingSide& b) const {
  contact.look->reset();
  contact.needed = neededSeparation(contact);
  const Age age = ageOf(contact, a, b);
  contact.a = a;
  contact.b = b;
  contact.valid = false;
  if (age == Age::current) return Task::carry;
  if (age == Age::moved) return Task::measure;
  contact.measure.emplace(options_, *a.packing, *b.packing, contact.needed);
  return contact.measure->on_surfaces ? Task::surfaces : Task::volumes;
}

void OverlapBatch::updateAlone(PackingContact& contact, const PackingSide& a, const PackingSide& b) {
  const Task task = place(contact, a, b);
  work_.clear();
  searches_.clear();
  jobsLike(task).push_back({&contact, task});
  if (!needsQuery(task)) workWithoutQuery(contact, task);
  startQueries();
  finishQueries(false);
}

void OverlapBatch::workWithoutQuery(PackingContact& contact, Task task) const {
  const ContactSettings& measure = *contact.measure;
  if (task == Task::carry) {
    contact.memory.carryTo(contact.placed(), *contact.a.packing, measure.spacing);
  } else {
    contact.memory.turnTo(contact.placed());
    measureOnSurfaces(Bodies(contact), contact);
    contact.memory.measuredAt(contact.placed(), measure.separation);
  }
  contact.valid = true;
}

void OverlapBatch::handOut(PackingContact& contact) const {
  Look& look = *contact.look;
  if (!contact.valid || !looks_.isFresh(look)) return;
  look.received = contact.separation == 0 &&
                  contact.receiver.receive(contact.memory.patches, options_, contact.time_step);
  const ContactSettings& measure = *contact.measure;
  if (!look.received || !measure.on_surfaces || contact.deep) return;
  const btScalar leeway = contact.memory.leeway(contact.placed(), contact.a.packing->getAngularMotionDisc(),
                                                contact.b.packing->getAngularMotionDisc(), measure.spacing);
  looks_.calm(look, leeway, measure.separation - ContactTransport::reserve(measure.spacing));
}

void OverlapBatch::startQueries() {
  makeQueries(Task::surfaces);
  countJobs();
  if (!queries_.empty()) context().start(queries_.data(), queries_.size(), optionsOf(Task::surfaces));
}

void OverlapBatch::finishQueries(bool hand_out) {
  if (!queries_.empty()) takeStarted(hand_out);
  for (const Task task : {Task::touch, Task::deep, Task::volumes}) {
    makeQueries(task);
    if (queries_.empty()) continue;
    context().run(queries_.data(), queries_.size(), optionsOf(task), result_);
    takeResults(task, hand_out);
  }
}

void OverlapBatch::takeStarted(bool hand_out) {
  context().wait(result_);
  takeResults(Task::surfaces, hand_out);
  queries_.clear();
}

void OverlapBatch::countJobs() {
  for (const Job& job : work_) {
    if (job.task == Task::measure) ++count_.measured;
  }
  count_.launches += searches_.empty() ? 0 : 1;
  count_.pairs += searches_.size();
}

void OverlapBatch::makeQueries(Task task) {
  queried_.clear();
  for (Job& job : searches_) {
    if (job.task == task) queried_.push_back(&job);
  }
  queries_.resize(queried_.size());
  inParallel(queried_.size(), [&](std::size_t i) { queries_[i] = makeQuery(task, *queried_[i]->contact); });
}

void OverlapBatch::takeResults(Task task, bool hand_out) {
  // Each pair has its own result, so that their order does not matter.
  inParallel(queried_.size(), [&](std::size_t i) {
    Job& job = *queried_[i];
    job.task = takeResult(task, i, *job.contact);
    job.contact->valid = job.task == Task::nothing;
    if (job.contact->valid && hand_out) handOut(*job.contact);
  });
}

QueryOptions OverlapBatch::optionsOf(Task task) const {
  switch (task) {
    case Task::surfaces:
      return {Want::contacts, Estimator::raw};
    case Task::touch:
      return {Want::touch, Estimator::raw};
    case Task::deep:
      return {Want::contacts, Estimator::volume_true};
    default:
      return {Want::contacts, options_.estimator};
  }
}

btScalar OverlapBatch::neededSeparation(const PackingContact& contact) const {
  return btMax(contact.separation, sweepOf(*contact.a.object, *contact.b.object, contact.time_step));
}

PairQuery OverlapBatch::makeQuery(Task task, const PackingContact& contact) const {
  const ContactSettings& measure = *contact.measure;
  PairQuery query;
  query.a = &contact.a.packing->model();
  query.b = &contact.b.packing->model();
  query.placement_a = PlacedPacking(*contact.a.packing, contact.a.transform, Estimator::raw, 0).placement();
  query.placement_b = PlacedPacking(*contact.b.packing, contact.b.transform, Estimator::raw, 0).placement();
  query.margin = contact.a.margin + contact.b.margin;
  query.prefix_a = static_cast<std::uint32_t>(measure.prefix_a->count);
  query.prefix_b = static_cast<std::uint32_t>(measure.prefix_b->count);
  if (task == Task::surfaces) query.margin += measure.search_margin();
  if (task == Task::deep) {
    query.margin +=
        gapsOf(*contact.a.packing, *measure.prefix_a) + gapsOf(*contact.b.packing, *measure.prefix_b);
  }
  return query;
}

/// Returns what is left to do for the pair.
OverlapBatch::Task OverlapBatch::takeResult(Task task, std::size_t index, PackingContact& contact) const {
  static thread_local std::vector<SphereContact> contacts;
  if (task == Task::touch) {
    contact.deep = result_.overlaps[index].pair_count > 0;
    return contact.deep ? Task::deep : Task::nothing;
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

  const ContactSettings& measure = *contact.measure;
  const btMatrix3x3& reference = contact.a.transform.getBasis();
  ContactTransport& memory = contact.memory;
  Task left = Task::nothing;
  if (task == Task::surfaces) {
    const Bodies bodies(contact);
    selectSamples(contacts, PackingProbe(bodies.a, bodies.b, contacts, count_a), measure.spacing, reference,
                  memory.patches, memory.samples);
    keepSamples(contacts, count_a, contact);
    const bool touching = measureOnSurfaces(bodies, contact);
    contact.deep = false;
    if (!contacts.empty() && !touching) left = Task::touch;
  } else if (task == Task::deep) {
    gradientPatch(contacts, measure.spacing, reference, memory.patches);
  } else {
    volumePatches(contacts, measure.spacing, reference, memory.patches);
    contact.overlap = result_.overlaps[index];
  }
  memory.searchedAt(contact.placed());
  memory.measuredAt(contact.placed(), measure.separation);
  return left;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
