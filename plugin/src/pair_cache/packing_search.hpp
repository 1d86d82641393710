// Searches for contact of many pairs of packings, in shared queries.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "common/parallel.hpp"
#include "innersphere/contact_options.hpp"
#include "innersphere/query_queue.hpp"
#include "narrow_phase/packing_vs_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Runs searches. All pairs go through the same passes together, each pass one query; pairs that are swept go
/// through the first one once for each pose. The first one can be
/// under way on a device while the caller does something else, unless searches share their queries with
/// others.
class PackingSearch {
 public:
  PackingSearch(const ContactOptions& options, std::size_t room);
  /// Returns true if these options would make it the same.
  bool isFor(const ContactOptions& options) const {
    return backend_ == options.backend && queue_ == options.queue;
  }
  /// Makes room for so many pairs, so that a search does not allocate.
  void reserve(std::size_t pairs);

  void clear();
  bool isEmpty() const { return items_.empty(); }
  /// Adds a pair whose search has begun; `index` tells done() which one it is.
  void add(PackingVsPacking& pair, SearchPass pass, std::size_t index) {
    items_.push_back({&pair, pass, index});
  }

  /// Starts the first pass. Throws Error from the query, as do the functions below.
  void start(Estimator estimator);
  /// Returns true if finish() can begin without waiting.
  bool isReady() { return !started_ || context_.ready(); }
  /// Waits for the first pass, takes its results and runs the others. Calls done(index), by any thread, for
  /// each pair once its search is over.
  template <typename Done>
  void finish(const Done& done) {
    if (started_) {
      started_ = false;
      context_.wait(result_);
      take(SearchPass::surfaces, done);
    }
    for (const SearchPass pass : {SearchPass::surfaces, SearchPass::nearby, SearchPass::touch,
                                  SearchPass::deep, SearchPass::volumes}) {
      for (makeQueries(pass); !queries_.empty(); makeQueries(pass)) {
        run(pass);
        take(pass, done);
      }
    }
    releaseUnused();
    clear();
  }
  /// Returns true if it holds more memory than searches of a usual size need, and is soon made anew.
  bool isLarge() const;
  /// Runs one query for volumes and returns its sums.
  Overlap overlap(const PairQuery& query, Estimator estimator);

 private:
  struct Item {
    PackingVsPacking* pair;
    SearchPass pass;
    std::size_t index;
  };
  void makeQueries(SearchPass pass);
  void run(SearchPass pass);
  /// Bodies that were deep in each other for once leave no memory behind.
  void releaseUnused();
  template <typename Done>
  void take(SearchPass pass, const Done& done) {
    most_contacts_ =
        std::max(most_contacts_, result_.contacts_a.items.size() + result_.contacts_b.items.size());
    // Each pair has its own result, so that their order does not matter.
    inParallel(queried_.size(), [&](std::size_t i) {
      Item& item = *queried_[i];
      item.pass = item.pair->take(pass, result_, i);
      if (item.pass == SearchPass::none) done(item.index);
    });
  }

  Backend backend_;
  std::shared_ptr<QueryQueue> queue_;  ///< null: queries of its own
  QueryContext context_;
  Estimator estimator_ = Estimator::volume_true;
  bool started_ = false;
  std::vector<Item> items_;
  std::vector<Item*> queried_;
  std::vector<PairQuery> queries_;
  QueryResult result_;
  std::size_t most_contacts_ = 0;  ///< of a pass since memory was last looked at
  int searches_ = 0;               ///< since then
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
