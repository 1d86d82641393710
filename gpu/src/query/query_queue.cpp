#include "innersphere/query_queue.hpp"

#include <array>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "batch/backend.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

namespace {

/// What goes into one query.
struct Round {
  std::vector<PairQuery> queries;
  QueryResult result;
  std::size_t sharers = 0;  ///< calls that have not read the result yet
  bool done = false;
  bool failed = false;
  std::condition_variable changed;

  void reset() {
    queries.clear();
    done = failed = false;
  }
};

template <typename T>
void copy(const QueryResult::Ranges<T>& from, std::size_t first, std::size_t count,
          QueryResult::Ranges<T>& to) {
  const std::size_t begin = from.first[first], end = from.first[first + count];
  to.items.assign(from.items.begin() + static_cast<std::ptrdiff_t>(begin),
                  from.items.begin() + static_cast<std::ptrdiff_t>(end));
  to.first.resize(count + 1);
  for (std::size_t q = 0; q <= count; ++q) to.first[q] = from.first[first + q] - begin;
}

void copy(const QueryResult& from, std::size_t first, std::size_t count, QueryResult& to) {
  const auto begin = from.overlaps.begin() + static_cast<std::ptrdiff_t>(first);
  to.overlaps.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
  copy(from.pairs, first, count, to.pairs);
  copy(from.contacts_a, first, count, to.contacts_a);
  copy(from.contacts_b, first, count, to.contacts_b);
}

/// All queries with the same options.
class Lane {
 public:
  explicit Lane(const QueryContextOptions& options) : context_(options), alone_(options) {}

  void run(const PairQuery* queries, std::size_t count, const QueryOptions& options, QueryResult& result) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!next_) next_ = take();
    Round& round = *next_;
    const std::size_t first = round.queries.size();
    round.queries.insert(round.queries.end(), queries, queries + count);
    ++round.sharers;
    ++calls_;
    round.changed.wait(lock, [&] { return round.done || !busy_; });
    if (!round.done) lead(round, options, lock);
    lock.unlock();
    const bool failed = round.failed;
    if (!failed) copy(round.result, first, count, result);
    lock.lock();
    if (--round.sharers == 0) spare_.push_back(&round);
    // Whose fault it is shows where each runs alone.
    if (failed) alone_.run(queries, count, options, result);
  }

  std::size_t sharedQueries() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return rounds_run_;
  }
  std::size_t calls() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return calls_;
  }

 private:
  Round* take() {
    if (spare_.empty()) return rounds_.emplace_back(std::make_unique<Round>()).get();
    Round* round = spare_.back();
    spare_.pop_back();
    round->reset();
    return round;
  }

  /// Runs the round that is next, which is this thread's own, while others gather for the one after it.
  void lead(Round& round, const QueryOptions& options, std::unique_lock<std::mutex>& lock) {
    next_ = nullptr;
    busy_ = true;
    ++rounds_run_;
    lock.unlock();
    bool failed = false;
    try {
      context_.run(round.queries.data(), round.queries.size(), options, round.result);
    } catch (...) {
      failed = true;
    }
    lock.lock();
    round.failed = failed;
    round.done = true;
    busy_ = false;
    round.changed.notify_all();
    if (next_) next_->changed.notify_one();
  }

  mutable std::mutex mutex_;
  QueryContext context_;  ///< of the thread that leads
  QueryContext alone_;    ///< of the one that holds the lock
  std::vector<std::unique_ptr<Round>> rounds_;
  std::vector<Round*> spare_;
  Round* next_ = nullptr;  ///< where calls gather
  bool busy_ = false;
  std::size_t rounds_run_ = 0, calls_ = 0;
};

constexpr std::size_t kWants = static_cast<std::size_t>(Want::pairs) + 1;
constexpr std::size_t kEstimators = static_cast<std::size_t>(Estimator::surface) + 1;

}  // namespace

struct QueryQueue::Impl {
  explicit Impl(const QueryContextOptions& o) : options(o) { of({}); }

  Lane& of(const QueryOptions& wanted) {
    const std::lock_guard<std::mutex> lock(mutex);
    const std::size_t kind =
        static_cast<std::size_t>(wanted.want) * kEstimators + static_cast<std::size_t>(wanted.estimator);
    std::unique_ptr<Lane>& lane = lanes[2 * kind + (wanted.sums ? 1 : 0)];
    if (!lane) lane = std::make_unique<Lane>(options);
    return *lane;
  }

  template <typename Count>
  std::size_t sum(const Count& count) {
    const std::lock_guard<std::mutex> lock(mutex);
    std::size_t all = 0;
    for (const auto& lane : lanes) all += lane ? count(*lane) : 0;
    return all;
  }

  QueryContextOptions options;
  std::mutex mutex;  ///< of lanes
  std::array<std::unique_ptr<Lane>, 2 * kWants * kEstimators> lanes;
};

QueryQueue::QueryQueue(const QueryContextOptions& options) : impl_(std::make_unique<Impl>(options)) {}
QueryQueue::~QueryQueue() = default;

void QueryQueue::run(const PairQuery* queries, std::size_t count, const QueryOptions& options,
                     QueryResult& result) {
  impl_->of(options).run(queries, count, options, result);
}

std::size_t QueryQueue::sharedQueries() const {
  return impl_->sum([](const Lane& lane) { return lane.sharedQueries(); });
}

std::size_t QueryQueue::calls() const {
  return impl_->sum([](const Lane& lane) { return lane.calls(); });
}

}  // namespace innersphere
