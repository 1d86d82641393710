#include "finish.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/fixed_sum.hpp"
#include "cpu_kernels.hpp"
#include "digit_sort.hpp"

namespace innersphere {

namespace {

Vec3d toVec(const double* terms) {
  return {terms[0], terms[1], terms[2]};
}

std::uint32_t high(std::uint64_t key) {
  return static_cast<std::uint32_t>(key >> 32);
}
std::uint32_t low(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}

constexpr std::size_t kFew = 256;  ///< keys are sorted sooner by comparing

template <typename T>
void clear(QueryResult::Ranges<T>& ranges, std::size_t queries) {
  ranges.items.clear();
  ranges.first.assign(queries + 1, 0);
}

}  // namespace

core::Totals toTotals(const core::Sums& sums, const core::Units& units) {
  core::Totals totals;
  totals.pairs = sums.pairs;
  for (int i = 0; i < core::kTerms; ++i) totals.terms[i] = core::toDouble(sums.terms[i], unitOf(units, i));
  return totals;
}

Overlap toOverlap(const core::Totals& totals) {
  Overlap overlap;
  overlap.pair_count = totals.pairs;
  overlap.volume = totals.terms[core::kVolume];
  if (overlap.volume > 0) {
    overlap.centroid = toVec(totals.terms + core::kMoment);
    for (double& c : overlap.centroid) c /= overlap.volume;
  }
  overlap.force = toVec(totals.terms + core::kForce);
  overlap.torque = toVec(totals.terms + core::kTorque);
  overlap.area = toVec(totals.terms + core::kArea);
  overlap.stiffness = totals.terms[core::kStiffness];
  overlap.energy = totals.terms[core::kEnergy];
  return overlap;
}

void HitSorter::run(const std::vector<PreparedQuery>& queries, const std::vector<core::Sums>& sums,
                    const Hits& hits, Want want, Workers& workers, QueryResult& result) {
  clear(result.pairs, queries.size());
  clear(result.contacts_a, queries.size());
  clear(result.contacts_b, queries.size());
  if (!wantsHits(want)) return;
  groupByQuery(sums, hits);
  sortGroups(queries, workers);
  if (want == Want::pairs) return writePairs(result.pairs);
  evaluate(queries, workers);
  writeContacts(false, workers, result.contacts_a);
  regroupByB(queries, workers);
  writeContacts(true, workers, result.contacts_b);
}

void HitSorter::groupByQuery(const std::vector<core::Sums>& sums, const Hits& hits) {
  first_.resize(sums.size() + 1);
  first_[0] = 0;
  for (std::size_t q = 0; q < sums.size(); ++q) first_[q + 1] = first_[q] + sums[q].pairs;
  cursor_.assign(first_.begin(), first_.end());
  keys_.resize(hits.count);
  spare_.resize(hits.count);
  for (std::size_t k = 0; k < hits.count; ++k) {
    const Hit& hit = hits.items[k];
    keys_[cursor_[hit.query]++] = std::uint64_t{hit.a} << 32 | hit.b;
  }
}

void HitSorter::sortGroups(const std::vector<PreparedQuery>& queries, Workers& workers) {
  workers.forRanges(queries.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      std::uint64_t* const group = keys_.data() + first_[q];
      const std::size_t count = first_[q + 1] - first_[q];
      if (count < kFew) {
        std::sort(group, group + count);
        continue;
      }
      std::uint64_t *keys = group, *spare = spare_.data() + first_[q];
      const auto key = [](std::uint64_t x) { return x; };
      sortByBits(keys, spare, count, key, 0, std::bit_width(queries[q].setup.b.grid.count - 1));
      sortByBits(keys, spare, count, key, 32, std::bit_width(queries[q].setup.a.grid.count - 1));
      if (keys != group) std::copy_n(keys, count, group);
    }
  });
}

void HitSorter::writePairs(QueryResult::Ranges<SpherePair>& pairs) const {
  pairs.first.assign(first_.begin(), first_.end());
  pairs.items.resize(keys_.size());
  for (std::size_t k = 0; k < keys_.size(); ++k) pairs.items[k] = {high(keys_[k]), low(keys_[k])};
}

void HitSorter::evaluate(const std::vector<PreparedQuery>& queries, Workers& workers) {
  values_.resize(keys_.size());
  workers.forRanges(keys_.size(), 4 * PairValues::kSize, [&](std::size_t begin, std::size_t end) {
    PairValues pairs;
    std::size_t q =
        static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), begin) - first_.begin());
    while (begin < end) {
      const std::size_t stop = std::min({end, first_[q], begin + PairValues::kSize});
      const PreparedQuery& query = queries[q - 1];
      if (begin < stop) {
        const HashGrid &a = query.grid_a->onCpu(), &b = query.grid_b->onCpu();
        for (std::size_t k = begin; k < stop; ++k) {
          pairs.a[k - begin] = a.placeOf(high(keys_[k]));
          pairs.b[k - begin] = b.placeOf(low(keys_[k]));
        }
        cpuKernels().evaluate(query.setup, stop - begin, pairs);
      }
      for (std::size_t k = begin; k < stop; ++k) {
        const auto value = [&](int i) { return pairs.of[static_cast<std::size_t>(i)][k - begin]; };
        constexpr int kMoment = PairValues::moment, kArea = PairValues::area;
        values_[k] = {value(PairValues::volume),
                      {value(kMoment), value(kMoment + 1), value(kMoment + 2)},
                      {value(kArea), value(kArea + 1), value(kArea + 2)}};
      }
      begin = stop;
      if (begin == first_[q]) ++q;
    }
  });
}

/// The hits are sorted by sphere of A, and keep that order among those of one sphere of B.
void HitSorter::regroupByB(const std::vector<PreparedQuery>& queries, Workers& workers) {
  workers.forRanges(queries.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      std::uint64_t* const group = keys_.data() + first_[q];
      const std::size_t count = first_[q + 1] - first_[q];
      assert(count >> 32 == 0);
      for (std::size_t k = 0; k < count; ++k) group[k] = std::uint64_t{low(group[k])} << 32 | k;
      if (count < kFew) {
        std::sort(group, group + count);
        continue;
      }
      std::uint64_t *keys = group, *spare = spare_.data() + first_[q];
      const auto key = [](std::uint64_t x) { return x; };
      sortByBits(keys, spare, count, key, 32, std::bit_width(queries[q].setup.b.grid.count - 1));
      if (keys != group) std::copy_n(keys, count, group);
    }
  });
}

/// Sums the lenses of one sphere with its partners, keys_[begin .. end): every kContactShares-th of them,
/// then these sums. So a device can sum those of a large sphere side by side, to the same bits.
SphereContact HitSorter::sumContact(std::size_t query, std::size_t begin, std::size_t end, bool of_b) const {
  Values shares[kContactShares];
  std::fill_n(shares, std::min<std::size_t>(kContactShares, end - begin), Values{0, {0, 0, 0}, {0, 0, 0}});
  const auto add = [](Values& sum, const Values& pair) {
    sum.volume += pair.volume;
    sum.moment = sum.moment + pair.moment;
    sum.area = sum.area + pair.area;
  };
  for (std::size_t k = begin; k < end; ++k)
    add(shares[(k - begin) % kContactShares], values_[of_b ? first_[query] + low(keys_[k]) : k]);
  Values sum{0, {0, 0, 0}, {0, 0, 0}};
  for (std::size_t s = 0; s < std::min<std::size_t>(kContactShares, end - begin); ++s) add(sum, shares[s]);
  const core::Vec3r centroid = sum.volume > 0 ? 1 / sum.volume * sum.moment : core::Vec3r{0, 0, 0};
  SphereContact contact;
  contact.sphere = high(keys_[begin]);
  contact.volume = static_cast<float>(sum.volume);
  contact.centroid = {static_cast<float>(centroid.x), static_cast<float>(centroid.y),
                      static_cast<float>(centroid.z)};
  contact.area = {static_cast<float>(sum.area.x), static_cast<float>(sum.area.y),
                  static_cast<float>(sum.area.z)};
  return contact;
}

void HitSorter::writeContacts(bool of_b, Workers& workers, QueryResult::Ranges<SphereContact>& contacts) {
  heads_.clear();
  for (std::size_t q = 0; q + 1 < first_.size(); ++q) {
    contacts.first[q] = heads_.size();
    for (std::size_t k = first_[q]; k < first_[q + 1]; ++k) {
      if (k == first_[q] || high(keys_[k]) != high(keys_[k - 1])) heads_.push_back(k);
    }
  }
  contacts.first.back() = heads_.size();
  contacts.items.resize(heads_.size());
  heads_.push_back(keys_.size());
  workers.forRanges(contacts.items.size(), 64, [&](std::size_t begin, std::size_t end) {
    auto query = std::upper_bound(contacts.first.begin(), contacts.first.end(), begin) - 1;
    for (std::size_t c = begin; c < end; ++c) {
      while (c >= query[1]) ++query;
      contacts.items[c] = sumContact(static_cast<std::size_t>(query - contacts.first.begin()), heads_[c],
                                     heads_[c + 1], of_b);
    }
  });
}

}  // namespace innersphere
