// Batches on the CPU: a batch is over when start() returns, as there is nobody else to work on it.
#pragma once

#include "batch/backend.hpp"
#include "cpu/cpu_backend.hpp"
#include "cpu/hit_sorter.hpp"

namespace innersphere {

class CpuQueries : public QueryBackend {
 public:
  explicit CpuQueries(Workers& workers) : workers_(workers), walk_(workers) {}

  void start(const std::vector<PreparedQuery>& queries, Want want) override {
    queries_ = &queries;
    want_ = want;
    walk_.run(queries, want, sums_, hits_);
  }

  bool ready() override { return true; }

  void finish(QueryResult& result) override {
    constexpr std::size_t kGrain = 64;
    sorter_.run(*queries_, sums_, hits_, want_, workers_, result);
    result.overlaps.resize(queries_->size());
    workers_.forRanges(queries_->size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        result.overlaps[i] = toOverlap(toTotals(sums_[i], (*queries_)[i].setup.units));
    });
  }

 private:
  Workers& workers_;
  CpuBackend walk_;
  const std::vector<PreparedQuery>* queries_ = nullptr;
  Want want_ = Want::wrench;
  std::vector<core::Sums> sums_;
  Hits hits_;
  HitSorter sorter_;
};

}  // namespace innersphere
