// Queries of many threads that go together: each gets the bits and the errors that it would get alone.
#include <atomic>
#include <barrier>
#include <thread>

#include "conformance.hpp"
#include "innersphere/error.hpp"
#include "innersphere/query_queue.hpp"

namespace innersphere::test {
namespace {

const std::size_t kThreads = cases(6, 2);

class QueueConformance : public Conformance {
 protected:
  std::shared_ptr<CollisionModel> a = makeModel(randomSpheres(1000, 0.2, 30, 1), true);
  std::shared_ptr<CollisionModel> b = makeModel(randomSpheres(300, 0.3, 20, 2), true);

  std::vector<PairQuery> batch(std::size_t count, unsigned seed) const {
    Random random(seed);
    std::vector<PairQuery> queries(count);
    for (PairQuery& query : queries) {
      query.a = a.get();
      query.b = b.get();
      query.placement_b = randomPlacement(random, random.uniform(0, 1.5));
    }
    return queries;
  }

  /// Calls f(number of the thread), by all of them at once.
  template <typename F>
  static void inThreads(const F& f) {
    std::barrier begin(static_cast<std::ptrdiff_t>(kThreads));
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < kThreads; ++t)
      threads.emplace_back([&, t] {
        begin.arrive_and_wait();
        f(t);
      });
    for (std::thread& thread : threads) thread.join();
  }
};

/// Threads ask for different numbers of pairs, want different things, and stop one after the other.
TEST_P(QueueConformance, EachThreadGetsWhatItWouldGetAlone) {
  QueryQueue queue({GetParam()});
  std::vector<std::vector<QueryResult>> results(kThreads);
  const auto wantOf = [](std::size_t thread, std::size_t i) {
    constexpr Want kWants[] = {Want::contacts, Want::wrench, Want::pairs, Want::contacts, Want::touch};
    return QueryOptions{kWants[(thread + i) % 5], i % 2 == 0 ? Estimator::volume_true : Estimator::raw,
                        (thread + i) % 5 != 0};
  };
  const auto queriesOf = [&](std::size_t thread, std::size_t i) {
    return batch((3 * thread + i) % 5, static_cast<unsigned>(100 * thread + i));
  };
  inThreads([&](std::size_t t) {
    for (std::size_t i = 0; i < cases(10, 2) + 2 * t; ++i) {
      const std::vector<PairQuery> queries = queriesOf(t, i);
      queue.run(queries.data(), queries.size(), wantOf(t, i), results[t].emplace_back());
    }
  });
  QueryContext alone = makeContext();
  std::size_t calls = 0;
  for (std::size_t t = 0; t < kThreads; ++t) {
    for (std::size_t i = 0; i < results[t].size(); ++i, ++calls) {
      const std::vector<PairQuery> queries = queriesOf(t, i);
      QueryResult expected;
      alone.run(queries.data(), queries.size(), wantOf(t, i), expected);
      expectSame(results[t][i], expected);
    }
  }
  EXPECT_EQ(queue.calls(), calls);
  EXPECT_LE(queue.sharedQueries(), calls);
}

TEST_P(QueueConformance, AnErrorIsThatOfItsOwnQueries) {
  QueryQueue queue({GetParam()});
  std::atomic<int> errors{0};
  QueryResult expected;
  std::vector<QueryResult> results(kThreads);
  const std::vector<PairQuery> good = batch(3, 7);
  makeContext().run(good.data(), good.size(), {}, expected);
  inThreads([&](std::size_t t) {
    std::vector<PairQuery> bad = good;
    bad[1].placement_b.scale = -1;
    for (std::size_t i = 0; i < cases(30, 4); ++i) {
      try {
        queue.run(t == 0 ? bad.data() : good.data(), 3, {}, results[t]);
      } catch (const Error& error) {
        EXPECT_EQ(t, 0u);
        EXPECT_NE(std::string(error.what()).find("query 1: "), std::string::npos) << error.what();
        ++errors;
      }
    }
  });
  EXPECT_EQ(errors, static_cast<int>(cases(30, 4)));
  for (std::size_t t = 1; t < kThreads; ++t) expectSame(results[t], expected);
}

INNERSPHERE_FOR_EACH_BACKEND(QueueConformance);

}  // namespace
}  // namespace innersphere::test
