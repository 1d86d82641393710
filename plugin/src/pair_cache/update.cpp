// The stages in which the pairs of a table are brought up to date.
#include <atomic>

#include "common/parallel.hpp"
#include "innersphere/error.hpp"
#include "pair_cache/pair_table.hpp"
#include "response/contact_law.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr int kUpdatesToKeepSearches = 64;

PackingVsPacking& packingsOf(ContactPair& pair) {
  return static_cast<PackingVsPacking&>(*pair.found);
}

Reuse reuseFor(const ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b,
               const StepSettings& settings) {
  return reuseOf(pair, a, b, settings.time_step, settings.options.reuse);
}

/// Takes a pair that is not idle to where its bodies are. False if that is not known, nor where they will be.
bool place(ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b) {
  if (!a.hasFiniteSpeed() || !b.hasFiniteSpeed()) return false;
  const std::optional<btTransform> at_a = pair.a.placeIn(a);
  const std::optional<btTransform> at_b = pair.b.placeIn(b);
  if (!at_a || !at_b) return false;
  pair.a.transform = *at_a;
  pair.b.transform = *at_b;
  pair.a.start = a.startOf(*at_a);
  pair.b.start = b.startOf(*at_b);
  return true;
}

StepAhead stepAheadOf(const ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b,
                      btScalar time_step) {
  const btVector3 origin = pair.origin();
  return {{a.start().getOrigin() - origin, a.velocity(), b.start().getOrigin() - origin, b.velocity(),
           isSwept(a.motion(), b.motion(), time_step)},
          time_step,
          neededSeparation(pair, a, b, time_step),
          btMin(a.motion().size, b.motion().size),
          btMax(depthAtRest(*a.object(), time_step), depthAtRest(*b.object(), time_step))};
}

/// The first pass of a search that needs queries.
SearchPass beginSearch(ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b,
                       const StepSettings& settings) {
  pair.noteShapes(settings.options);
  return packingsOf(pair).begin(pair.options, pair.placed(), stepAheadOf(pair, a, b, settings.time_step));
}

/// All that is done without a query.
void updateWithoutQuery(ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b, Reuse reuse,
                        const StepSettings& settings) {
  const StepAhead step = stepAheadOf(pair, a, b, settings.time_step);
  if (reuse == Reuse::transport)
    pair.found->memory.carryTo(pair.placed(), *pair.a.packing, pair.found->settings->spacing);
  if (reuse == Reuse::refine && !pair.found->refine(pair.placed(), step)) reuse = Reuse::search;
  if (reuse != Reuse::search) return;
  pair.noteShapes(settings.options);
  static_cast<PackingVsShape&>(*pair.found).search(pair.options, pair.placed(), step);
}

}  // namespace

void PairTable::begin(btScalar time_step) {
  // Bodies that were deep in each other for once, and then lie still, leave no memory behind.
  if (++updates_without_search_ == kUpdatesToKeepSearches)
    std::erase_if(spare_searches_, [](const auto& search) { return search->isLarge(); });
  ++number_;
  settings_ = settingsFor(time_step);
  body_list_.forEachInParallel([&](BodySnapshot& body) { body.take(settings_.time_step); });
  noteWays();
  countNeighbours();
  jobs_.assign(pairs_.size(), Job());
  pairs_.forEachInParallel([&](ContactPair& pair) { jobs_[pair.list_index] = decide(pair); });
  collectJobs();
  work();
}

/// For solvers that let bodies go on after they have met. Bullet's hands an impact on to the next body at
/// once, without its restitution.
void PairTable::noteWays() {
  if (!settings_.solver.substeps) return;
  pairs_.forEachInParallel([&](ContactPair& pair) {
    // Other dispatchers do not know yet of a pair that is announced, and bodies are to move the same with
    // all.
    if (!pair.asked || pair.busy || pair.announced) return;
    noteWay(pair, *pair.body_a, *pair.body_b, settings_.time_step);
  });
}

/// For the law of chains, which SubstepSolver does without.
void PairTable::countNeighbours() {
  if (settings_.solver.substeps) return;
  pairs_.forEachInParallel([](const ContactPair& pair) {
    if (pair.busy || !(pair.depth > 0)) return;
    pair.body_a->noteNeighbour();
    pair.body_b->noteNeighbour();
  });
}

PairTable::Job PairTable::decide(ContactPair& pair) const {
  if (!pair.asked || pair.busy) return {};
  pair.step = number_;
  pair.announced = false;
  const BodySnapshot &a = *pair.body_a, &b = *pair.body_b;
  const Reuse reuse = reuseFor(pair, a, b, settings_);
  if (reuse == Reuse::idle) {
    pair.asked = false;
    return {&pair, reuse, SearchPass::none};
  }
  pair.published = false;
  pair.safe = SafeDistance();
  // Bullet does not dispatch pairs of bodies that are both at rest.
  if ((!a.isActive() && !b.isActive()) || !place(pair, a, b)) return {};
  pair.asked = false;
  const bool queries = reuse == Reuse::search && pair.of_packings;
  return {&pair, reuse, queries ? beginSearch(pair, a, b, settings_) : SearchPass::none};
}

void PairTable::collectJobs() {
  work_.clear();
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    const Job& job = jobs_[i];
    if (job.pair == nullptr) continue;
    count(job.reuse);
    if (job.pass != SearchPass::none) {
      if (!search_) search_ = takeSearch();
      search_->add(packingsOf(*job.pair), job.pass, i);
    } else if (job.reuse != Reuse::idle) {
      work_.push_back(job);
    }
  }
  if (!search_) return;
  ++statistics_.queries;
  updates_without_search_ = 0;
}

/// Transports, refines and searches without queries, while a device is at work on those.
void PairTable::work() {
  const auto search = [&](const std::atomic<bool>& working) {
    if (!search_) return;
    search_->start(options_.estimator);
    // A device goes on to its next pass when it is asked whether it is done.
    while (working && search_) {
      if (search_->isReady()) finish();
    }
  };
  inParallelBeside(search, work_.size(), [&](std::size_t i) {
    ContactPair& pair = *work_[i].pair;
    updateWithoutQuery(pair, *pair.body_a, *pair.body_b, work_[i].reuse, settings_);
    publish(pair);
  });
}

void PairTable::publish(ContactPair& pair) {
  pair.time_step = settings_.time_step;
  pair.published = pair.canBePublished();
  if (!pair.published) return;
  pair.publish(settings_, *pair.body_a, *pair.body_b);
  noticeContact(pair, settings_);
  pair.safe = safeDistanceOf(pair, *pair.body_a, *pair.body_b);
}

void PairTable::finish() {
  if (!search_) return;
  try {
    search_->finish([&](std::size_t index) { publish(*jobs_[index].pair); });
  } catch (const Error&) {
    // Each pair hears of it when Bullet asks for it: what was to be searched is not known.
  }
  giveBack(std::move(search_));
}

void PairTable::updateAlone(ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b,
                            const StepSettings& settings) {
  pair.safe = SafeDistance();
  const Reuse reuse = reuseFor(pair, a, b, settings);
  place(pair, a, b);
  const bool queries = reuse == Reuse::search && pair.of_packings;
  std::unique_ptr<PackingSearch> search;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (pair.body_a != nullptr) count(reuse);  // closest-point queries are no part of a step
    if (queries) search = takeSearch();
    if (queries) ++statistics_.queries;
  }
  if (!queries) return updateWithoutQuery(pair, a, b, reuse, settings);
  search->add(packingsOf(pair), beginSearch(pair, a, b, settings), 0);
  search->start(settings.options.estimator);
  search->finish([](std::size_t) {});
  const std::lock_guard<std::mutex> lock(mutex_);
  giveBack(std::move(search));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
