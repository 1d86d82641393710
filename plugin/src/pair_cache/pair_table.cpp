#include "pair_cache/pair_table.hpp"

#include <algorithm>

#include "common/body_name.hpp"
#include "common/log.hpp"
#include "common/parallel.hpp"
#include "innersphere/error.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Whether a side is where it was in the last update.
bool isWhereItWas(const PairSide& side, const BodySnapshot& body, bool published,
                  const btCollisionObjectWrapper& wrapper) {
  // Idle pairs are not told where they are.
  const btTransform& place = published && side.isWhole() ? body.transform() : side.transform;
  return side.isFor(wrapper) && place == wrapper.getWorldTransform();
}

/// `plain`: no child of a compound. Most pairs are that, and then the side, which is far away, is not read.
bool isAsTaken(bool plain, const PairSide& side, const BodySnapshot& body,
               const btCollisionObjectWrapper& wrapper) {
  if (plain) return body.isAsTaken(wrapper);
  return side.isFor(wrapper) && side.transform == wrapper.getWorldTransform() && body.isAsTaken();
}

/// Keeps only points where surfaces are apart. Returns true if there were others.
bool dropTouching(std::vector<ContactPatch>& patches) {
  bool any = false;
  for (ContactPatch& patch : patches) {
    const auto end = patch.points.begin() + patch.count;
    const auto kept =
        std::remove_if(patch.points.begin(), end, [](const ContactPoint& point) { return point.depth >= 0; });
    any = any || kept != end;
    patch.count = int(kept - patch.points.begin());
  }
  return any;
}

/// A pair that one thread works on alone, while others may update the table.
class Busy {
 public:
  Busy(ContactPair& pair, std::mutex& mutex, const std::uint64_t& number)
      : pair_(pair), mutex_(mutex), number_(number) {
    pair_.busy = true;
  }
  ~Busy() {
    const std::lock_guard<std::mutex> lock(mutex_);
    pair_.busy = false;
    pair_.asked = true;
    pair_.step = number_;
  }

 private:
  ContactPair& pair_;
  std::mutex& mutex_;
  const std::uint64_t& number_;
};

}  // namespace

void PairTable::setOptions(const ContactOptions& options) {
  const std::lock_guard<std::mutex> lock(mutex_);
  finish();
  options_ = options;
  std::erase_if(spare_searches_, [&](const auto& search) { return !search->isFor(options); });
  pairs_.forEach([](ContactPair& pair) { pair.forgetContact(); });
}

ContactOptions PairTable::options() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return options_;
}

void PairTable::setWorld(btDynamicsWorld* world) {
  const std::lock_guard<std::mutex> lock(mutex_);
  world_ = world;
  awaits_contact_ = world != nullptr;
  lacks_directions_ = false;
}

void PairTable::noticeContact(const ContactPair& pair, const StepSettings& settings) {
  if (!awaits_contact_.load(std::memory_order_relaxed) || !pair.hasFriction()) return;
  if (awaits_contact_.exchange(false) && settings.solver.one_friction_row) lacks_directions_ = true;
}

void PairTable::logSolver() {
  if (!lacks_directions_.load(std::memory_order_relaxed) || !lacks_directions_.exchange(false)) return;
  log("The world's solver holds contacts in one direction only, so that grippers drop what they hold, arches "
      "fall and piles creep: call PackingCollisionAlgorithm::prepareWorld(world), which sets "
      "SOLVER_USE_2_FRICTION_DIRECTIONS, in place of registerAlgorithm(world).");
}

ContactPair& PairTable::add() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (unused_.empty()) {
    unused_.push_back(&places_.emplace_back(dispatcher_));
    unused_.reserve(places_.size());
  }
  ContactPair& pair = *unused_.back();
  unused_.pop_back();
  return pair;
}

void PairTable::remove(ContactPair& pair) {
  const std::lock_guard<std::mutex> lock(mutex_);
  finish();
  unlist(pair);
  pair.clear();
  unused_.push_back(&pair);
}

void PairTable::list(ContactPair& pair) {
  pair.body_a = use(pair.a);
  pair.body_b = use(pair.b);
  pairs_.add(&pair);
  // There may be something to do for any number of them in one step, which should not allocate then.
  jobs_.reserve(pairs_.capacity());
  work_.reserve(pairs_.capacity());
}

void PairTable::unlist(ContactPair& pair) {
  if (pair.body_a == nullptr) return;
  pairs_.remove(&pair);
  release(pair.body_a);
  release(pair.body_b);
  pair.body_a = pair.body_b = nullptr;
}

BodySnapshot* PairTable::use(const PairSide& side) {
  BodySnapshot& body = bodies_.try_emplace(side.object, *side.object, btScalar(0)).first->second;
  if (body.users++ == 0) body_list_.add(&body);
  return &body;
}

void PairTable::release(const BodySnapshot* body) {
  BodySnapshot& used = bodies_.at(body->object());
  if (--used.users > 0) return;
  body_list_.remove(&used);
  bodies_.erase(body->object());
}

void PairTable::take(ContactPair& pair, const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                     bool swapped) {
  if (pair.body_a != nullptr &&
      (pair.a.object != a.getCollisionObject() || pair.b.object != b.getCollisionObject()))
    unlist(pair);
  pair.set(a, b, swapped);
  if (pair.body_a == nullptr) list(pair);
}

void PairTable::process(ContactPair& pair, const btCollisionObjectWrapper& a,
                        const btCollisionObjectWrapper& b, bool swapped, const btDispatcherInfo& dispatch,
                        btManifoldResult* result) {
  const btScalar separation = result->m_closestPointDistanceThreshold;
  std::unique_lock<std::mutex> lock(mutex_);
  finish();
  const auto isUpToDate = [&] {
    if (!isDone(pair, a, b, dispatch.m_timeStep, separation)) return false;
    pair.asked = true;
    return true;
  };
  if (isUpToDate()) return;
  const auto hasMoved = [&] {
    return !isWhereItWas(pair.a, *pair.body_a, pair.published, a) ||
           !isWhereItWas(pair.b, *pair.body_b, pair.published, b);
  };
  if (pair.body_a != nullptr && pair.step == number_ && hasMoved()) {
    begin(dispatch.m_timeStep);
    finish();
    if (isUpToDate()) return;
  }
  take(pair, a, b, swapped);
  if (pair.separation != separation) pair.forgetContact();
  pair.separation = separation;
  pair.published = false;
  const StepSettings settings = settingsFor(dispatch.m_timeStep);
  BodySnapshot body_a(a, settings.time_step), body_b(b, settings.time_step);
  if (pair.body_a != nullptr) {
    body_a.noteWay(pair.body_a->way());
    body_b.noteWay(pair.body_b->way());
  }
  const Busy busy(pair, mutex_, number_);
  lock.unlock();

  const bool known = updateOrLog(pair, body_a, body_b, settings);
  if (!known) pair.found->drop();
  pair.time_step = settings.time_step;
  pair.write(settings, body_a, body_b, result);
  noticeContact(pair, settings);
  pair.penalty = PenaltyReport();
  if (known) push(pair, settings, dispatch);
}

void PairTable::report(ContactPair& pair, const btCollisionObjectWrapper& a,
                       const btCollisionObjectWrapper& b, btManifoldResult* result) {
  pair.set(a, b, false);
  std::unique_lock<std::mutex> lock(mutex_);
  const StepSettings settings = settingsFor(0);
  const BodySnapshot body_a(a, 0), body_b(b, 0);
  lock.unlock();
  const auto search = [&](btScalar separation) {
    pair.forgetContact();
    pair.separation = separation;
    return updateOrLog(pair, body_a, body_b, settings);
  };
  const btScalar distance = result->m_closestPointDistanceThreshold;
  if (!search(distance)) return;
  if (distance > 0) {
    // What looks that far around bodies that are deep in each other meets other sides of them.
    std::vector<ContactPatch> apart = pair.found->patches();
    if (dropTouching(apart)) {
      pair.report(apart, result);
      if (!search(0)) return;
    }
  }
  pair.report(pair.found->patches(), result);
}

bool PairTable::updateOrLog(ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b,
                            const StepSettings& settings) {
  for (const BodySnapshot* body : {&a, &b}) {
    const bool placed = isFinite(*body->shapePlace());
    if (placed && body->hasFiniteSpeed()) continue;
    pair.logOnce("The " + std::string(placed ? "velocity" : "transform") + " of the body with " +
                 numbersOf(*body->object()) + " is not finite" + (placed ? ", or is too large" : "") +
                 "; its contacts are skipped. Mend it, or remove the body from the world.");
    return false;
  }
  try {
    updateAlone(pair, a, b, settings);
    return true;
  } catch (const Error& error) {
    const bool bad_input = error.code() == ErrorCode::bad_argument || error.code() == ErrorCode::not_finite;
    pair.logOnce("Contacts are skipped between A, the body with " + numbersOf(*a.object()) +
                 ", and B, the one with " + numbersOf(*b.object()) + ": " + error.what() +
                 (bad_input ? ". Look at what setWorldTransform() and the shapes were given." : ""));
    return false;
  }
}

void PairTable::announce(ContactPair& pair, const btCollisionObjectWrapper& a,
                         const btCollisionObjectWrapper& b) {
  const std::lock_guard<std::mutex> lock(mutex_);
  finish();
  take(pair, a, b, false);
  pair.asked = pair.announced = true;
  pair.step = number_;
}

void PairTable::beginUpdate(btScalar time_step) {
  const std::lock_guard<std::mutex> lock(mutex_);
  finish();
  begin(time_step);
}

void PairTable::finishUpdate() {
  const std::lock_guard<std::mutex> lock(mutex_);
  finish();
}

void PairTable::compareBodies() {
  const std::lock_guard<std::mutex> lock(mutex_);
  body_list_.forEachInParallel([](BodySnapshot& body) { body.compare(); });
}

bool PairTable::isDone(const ContactPair& pair, btScalar time_step) const {
  return isFresh(pair, time_step) && !pair.body_a->hasChanged() && !pair.body_b->hasChanged();
}

bool PairTable::isDone(const ContactPair& pair, const btCollisionObjectWrapper& a,
                       const btCollisionObjectWrapper& b, btScalar time_step, btScalar separation) const {
  return isFresh(pair, time_step) && pair.separation == separation &&
         isAsTaken(pair.plain, pair.a, *pair.body_a, a) && isAsTaken(pair.plain, pair.b, *pair.body_b, b);
}

std::vector<PairOverlap> PairTable::overlaps() {
  const std::lock_guard<std::mutex> lock(mutex_);
  finish();
  std::vector<PairOverlap> overlaps;
  std::unique_ptr<PackingSearch> search = takeSearch();
  pairs_.forEach([&](const ContactPair& pair) {
    const bool lives = pair.a.placeIn(*pair.body_a) && pair.b.placeIn(*pair.body_b);
    if (lives && pair.hasPoints()) overlaps.push_back(pair.read(overlapOf(pair, *search)));
  });
  giveBack(std::move(search));
  return overlaps;
}

void PairTable::appendManifolds(btManifoldArray& manifolds) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  pairs_.forEach([&](const ContactPair& pair) { pair.manifolds.append(manifolds); });
}

ContactStatistics PairTable::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return statistics_;
}

void PairTable::push(ContactPair& pair, const StepSettings& settings, const btDispatcherInfo& dispatch) {
  const ContactLaw law = pair.lawOf(settings);
  if (!law.penalty() || !(settings.time_step > 0)) return;
  std::unique_lock<std::mutex> lock(mutex_);
  // Pairs can be dispatched several times in a step: by character controllers, or by a user who asks for
  // collisions between steps. A world sets its count to 0 at the start of each step, and nobody in Bullet
  // writes to it after that. The object is the world's own and not constant.
  int& mark = const_cast<btDispatcherInfo&>(dispatch).m_stepCount;
  if (mark == 0) {
    mark = 1;
    ++dispatches_;
  }
  if (pair.pushed_step == dispatches_) return;
  pair.pushed_step = dispatches_;
  // A contact test walks a compound with the algorithms of a step, but its result keeps no point.
  if (!pair.hasPoints()) return;
  std::unique_ptr<PackingSearch> search = takeSearch();
  lock.unlock();
  const bool responds = dispatcher_->needsResponse(pair.a.object, pair.b.object);
  const Overlap shared = responds ? overlapOf(pair, *search) : Overlap();
  lock.lock();
  giveBack(std::move(search));
  if (!responds) return;
  static thread_local btManifoldArray manifolds;
  manifolds.resize(0);
  pair.manifolds.append(manifolds);
  const btVector3 arm =
      pair.of_packings ? pair.b.packing->impl().toWorld(pair.b.start).getOrigin() : pair.origin();
  // Bodies take one push at a time.
  pair.penalty = Penalty(*pair.a.object, *pair.b.object, btScalar(pair.options.damping), settings.time_step)
                     .push(shared, law.penaltyStiffness(), arm, manifolds);
}

Overlap PairTable::overlapOf(const ContactPair& pair, PackingSearch& search) const {
  if (const Overlap* known = pair.found->overlap()) return *known;
  if (pair.of_packings) {
    const auto& packings = static_cast<const PackingVsPacking&>(*pair.found);
    return search.overlap(packings.makeVolumeQuery(pair.options, pair.placed()), options_.estimator);
  }
  return static_cast<const PackingVsShape&>(*pair.found).volumesAt(pair.options, pair.placed());
}

void PairTable::count(Reuse reuse) {
  switch (reuse) {
    case Reuse::idle:
      ++statistics_.idle;
      break;
    case Reuse::transport:
      ++statistics_.transported;
      break;
    case Reuse::refine:
      ++statistics_.refined;
      break;
    case Reuse::search:
      ++statistics_.searched;
  }
}

StepSettings PairTable::settingsFor(btScalar time_step) const {
  return {options_, world_ == nullptr ? SolverSettings() : SolverSettings(*world_), time_step};
}

std::unique_ptr<PackingSearch> PairTable::takeSearch() {
  if (spare_searches_.empty()) return std::make_unique<PackingSearch>(options_, pairs_.capacity());
  std::unique_ptr<PackingSearch> search = std::move(spare_searches_.back());
  spare_searches_.pop_back();
  search->reserve(pairs_.capacity());
  return search;
}

void PairTable::giveBack(std::unique_ptr<PackingSearch> search) {
  search->clear();
  if (search->isFor(options_)) spare_searches_.push_back(std::move(search));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
