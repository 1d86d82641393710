// The kernels for every generation of processors give the same bits.
#include "cpu/kernels.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <iterator>
#include <utility>
#include <vector>

#include "batch/prepare.hpp"
#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Keeps all candidates, and sums them.
class Recorder : public CandidateSink {
 public:
  Recorder(const CpuKernels& kernels, const core::Setup& setup) : kernels_(kernels), setup_(setup) {}
  bool take(Candidates& candidates) override {
    if (candidates.count == 0) return true;
    for (std::size_t k = 0; k < candidates.count; ++k)
      pairs.push_back({candidates.query_sphere[k], candidates.partner[k]});
    tallies.emplace_back();
    kernels_.sumAll(setup_, true, candidates, tallies.back());
    recordContacts(tallies.back(), candidates.count);
    Tally decided;
    kernels_.decide(setup_, true, candidates, decided);
    EXPECT_EQ(valuesOf(pairsOf(decided, candidates.count)),
              valuesOf(pairsOf(tallies.back(), candidates.count)));
    tallies.emplace_back();
    kernels_.sumVolumes(setup_, true, candidates, tallies.back());
    candidates.count = 0;
    return true;
  }
  std::vector<std::uint32_t> balls;  ///< of the clusters: do they meet?
  Pairs pairs;
  std::vector<Tally> tallies;
  std::vector<double> values;   ///< of all that count
  std::vector<float> contacts;  ///< of three of them each, and a last one of the rest, of many

 private:
  std::vector<ContactValues> pairsOf(const Tally& tally, std::size_t count) const {
    std::vector<ContactValues> found_pairs(tally.pairs);
    kernels_.writeValues(tally, count, found_pairs.data());
    return found_pairs;
  }
  static std::vector<double> valuesOf(const std::vector<ContactValues>& found_pairs) {
    std::vector<double> all;
    for (const ContactValues& found : found_pairs)
      all.insert(all.end(), std::begin(found.of), std::end(found.of));
    return all;
  }
  void recordContacts(const Tally& tally, std::size_t count) {
    const std::vector<ContactValues> found_pairs = pairsOf(tally, count);
    const std::vector<double> all = valuesOf(found_pairs);
    values.insert(values.end(), all.begin(), all.end());
    std::vector<std::uint32_t> order;
    for (int turn = 0; turn < 3; ++turn) {
      for (std::uint32_t k = 0; k < found_pairs.size(); ++k) order.push_back(k);
    }
    std::vector<std::size_t> heads;
    for (std::size_t k = 0; k + 3 < found_pairs.size(); k += 3) heads.push_back(k);
    heads.push_back(order.size());
    std::vector<SphereContact> sums(heads.size() - 1);
    kernels_.sumContacts(found_pairs.data(), order.data(), heads.data(), 0, sums.size(), sums.data());
    for (const SphereContact& sum : sums) {
      contacts.push_back(sum.volume);
      contacts.insert(contacts.end(), sum.centroid.begin(), sum.centroid.end());
      contacts.insert(contacts.end(), sum.area.begin(), sum.area.end());
    }
  }

  const CpuKernels& kernels_;
  const core::Setup& setup_;
};

Recorder record(const CpuKernels& kernels, const PreparedQuery& query) {
  Recorder recorder(kernels, query.setup);
  Candidates candidates;
  const core::Traversal traversal = core::traversalOf(query.setup, true);
  for (std::uint32_t c = 0; c < query.setup.clusters[0]; ++c)
    recorder.balls.push_back(kernels.ballsMeeting(traversal, query.grid_b->onCpu().occupancy(),
                                                  &traversal.own.clusters[c].ball, 1));
  for (std::uint32_t c = 0; c < query.setup.clusters[0]; ++c)
    EXPECT_TRUE(
        kernels.traverse(traversal, query.grid_b->onCpu().listedSpheres(), &c, 1, candidates, recorder));
  recorder.take(candidates);
  return recorder;
}

TEST(CpuKernels, AllGiveTheSameBits) {
  const auto a = makeModel(randomSpheres(2000, 0.2, 30, 1), true),
             b = makeModel(randomSpheres(700, 0.3, 20, 2), true);
  PairQuery query;
  query.a = a.get();
  query.b = b.get();
  query.placement_b = at({0.4, 0.1, 0});
  query.margin = 0.001;
  KnownGrids grids;
  PreparedQuery prepared = prepare(query, 0, Estimator::volume_true, grids);
  bringToCpu(prepared);
  const Recorder first = record(*supportedKernels().front(), prepared);
  EXPECT_GT(first.pairs.size(), 500u);
  for (const CpuKernels* kernels : supportedKernels()) {
    const Recorder other = record(*kernels, prepared);
    EXPECT_EQ(first.balls, other.balls);
    EXPECT_EQ(first.pairs, other.pairs);
    ASSERT_EQ(first.tallies.size(), other.tallies.size());
    for (std::size_t i = 0; i < first.tallies.size(); ++i) {
      const Tally &x = first.tallies[i], &y = other.tallies[i];
      EXPECT_EQ(x.pairs, y.pairs);
      EXPECT_EQ(std::memcmp(x.sums.data(), y.sums.data(), sizeof x.sums), 0);
    }
    EXPECT_EQ(first.values, other.values);
    EXPECT_EQ(first.contacts, other.contacts);
  }
}

}  // namespace
}  // namespace innersphere::test
