#include "cuda/split_backend.hpp"

#include <algorithm>
#include <exception>
#include <thread>
#include <utility>

namespace innersphere {

namespace {

/// A part of a sweep is at most this share of what each device would get, so that all end at about one time.
constexpr std::size_t kPartsOfADevice = 8;
constexpr std::size_t kMostPoses = std::size_t{1} << 14;  ///< in a part

class SplitBackend : public QueryBackend {
 public:
  explicit SplitBackend(std::vector<std::unique_ptr<OneDevice>> devices)
      : devices_(std::move(devices)), results_(devices_.size()) {}

  void start(std::span<const PreparedQuery> queries, Want want) override {
    std::size_t clusters = 0, taken = 0;
    for (const PreparedQuery& query : queries) clusters += query.clusters();
    ends_.clear();
    std::size_t end = 0;
    for (std::size_t d = 1; d < devices_.size(); ++d) {
      for (; end < queries.size() && taken * devices_.size() < clusters * d; ++end)
        taken += queries[end].clusters();
      ends_.push_back(end);
    }
    ends_.push_back(queries.size());
    onEach(
        [&](std::size_t d) { devices_[d]->start(queries.subspan(beginOf(d), ends_[d] - beginOf(d)), want); });
  }

  bool ready() override {
    bool all = true;
    for (const auto& device : devices_) all = device->ready() && all;  // each starts what is next
    return all;
  }

  void finish(QueryResult& result) override {
    onEach([&](std::size_t d) { devices_[d]->finish(results_[d]); });
    result.overlaps.clear();
    for (const QueryResult& part : results_)
      result.overlaps.insert(result.overlaps.end(), part.overlaps.begin(), part.overlaps.end());
    join(&QueryResult::pairs, result);
    join(&QueryResult::contacts_a, result);
    join(&QueryResult::contacts_b, result);
  }

  void sweep(const Sweep& sweep, Overlap* overlaps) override {
    const std::size_t share = sweep.poses.count / (devices_.size() * kPartsOfADevice);
    const std::size_t poses = std::clamp<std::size_t>(share, 1, kMostPoses);
    std::atomic<std::size_t> next{0};
    std::vector<SweepFault> faults(devices_.size());
    onEach([&](std::size_t d) { faults[d] = devices_[d]->sweepParts(sweep, poses, next, overlaps); });
    SweepFault first;
    for (const SweepFault& fault : faults) first.take(fault);
    first.throwIfAny();
  }

  double kernelTime() const override {
    double most = 0;
    for (const auto& device : devices_) most = std::max(most, device->kernelTime());
    return most;
  }

 private:
  std::size_t beginOf(std::size_t device) const { return device == 0 ? 0 : ends_[device - 1]; }

  /// Calls f(d) for each device, at once; throws what the first of them threw.
  template <typename F>
  void onEach(const F& f) {
    std::vector<std::exception_ptr> errors(devices_.size());
    const auto guarded = [&](std::size_t d) {
      try {
        f(d);
      } catch (...) {
        errors[d] = std::current_exception();
      }
    };
    std::vector<std::thread> threads;
    for (std::size_t d = 1; d < devices_.size(); ++d) threads.emplace_back(guarded, d);
    guarded(0);
    for (std::thread& thread : threads) thread.join();
    for (const std::exception_ptr& error : errors) {
      if (error) std::rethrow_exception(error);
    }
  }

  template <typename T>
  void join(QueryResult::Ranges<T> QueryResult::*lists, QueryResult& result) const {
    QueryResult::Ranges<T>& all = result.*lists;
    all.items.clear();
    all.first.assign(1, 0);
    for (const QueryResult& part : results_) {
      const std::size_t before = all.items.size();
      all.items.insert(all.items.end(), (part.*lists).items.begin(), (part.*lists).items.end());
      for (std::size_t q = 1; q < (part.*lists).first.size(); ++q)
        all.first.push_back(before + (part.*lists).first[q]);
    }
  }

  std::vector<std::unique_ptr<OneDevice>> devices_;
  std::vector<QueryResult> results_;
  std::vector<std::size_t> ends_;  ///< of the queries of each device
};

}  // namespace

std::unique_ptr<QueryBackend> splitOver(std::vector<std::unique_ptr<OneDevice>> devices) {
  return std::make_unique<SplitBackend>(std::move(devices));
}

}  // namespace innersphere
