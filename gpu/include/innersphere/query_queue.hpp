// Shares queries among many threads.
#pragma once

#include <cstddef>
#include <memory>

#include "innersphere/query.hpp"

namespace innersphere {

/// Runs the small queries of many threads as few large ones. The first thread that asks runs its own query at
/// once, and what others ask for meanwhile is the next one. So nobody waits for a thread that has nothing to
/// ask, and there is no time limit to choose: the more there is to do, the more goes into one query. Each
/// thread gets the bits that it would get alone. Safe to use from any number of threads at once.
class QueryQueue {
 public:
  /// Makes a queue whose contexts have these options. Throws Error as QueryContext() does.
  explicit QueryQueue(const QueryContextOptions& options = {});
  ~QueryQueue();

  /// Does what QueryContext::run() does, and throws what it would throw for these queries. Waits until the
  /// query under way is done, and then for its own.
  void run(const PairQuery* queries, std::size_t count, const QueryOptions& options, QueryResult& result);

  /// Returns how many queries were run for all threads so far.
  std::size_t sharedQueries() const;
  /// Returns how many calls of run() have had a share in them.
  std::size_t calls() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace innersphere
