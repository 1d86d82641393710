#include "cpu/pair_sorter.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "common/radix_sort.hpp"
#include "cpu/kernels.hpp"

namespace innersphere {

namespace {

constexpr std::size_t kFew = 64;  ///< are sorted sooner by comparing

template <typename T>
void clearRanges(QueryResult::Ranges<T>& ranges, std::size_t queries) {
  ranges.items.clear();
  ranges.first.assign(queries + 1, 0);
}

}  // namespace

void PairSorter::clear(std::size_t queries, QueryResult& result) {
  clearRanges(result.pairs, queries);
  clearRanges(result.contacts_a, queries);
  clearRanges(result.contacts_b, queries);
}

void PairSorter::append(std::span<const PreparedQuery> queries, const std::vector<core::Sums>& sums,
                        std::size_t begin, std::size_t end, const OverlappingPairs& found_pairs, Want want,
                        Workers& workers, QueryResult& result) {
  begin_ = begin;
  first_.resize(end - begin + 1);
  groupByQuery(sums, found_pairs);
  sortGroups(queries, found_pairs, &OverlappingPair::a, &OverlappingPair::b, workers);
  if (want == Want::pairs) return writePairs(found_pairs, result.pairs);
  writeContacts(found_pairs, &OverlappingPair::a, workers, result.contacts_a);
  if (want == Want::contacts_of_a) return;
  sortGroups(queries, found_pairs, &OverlappingPair::b, nullptr, workers);
  writeContacts(found_pairs, &OverlappingPair::b, workers, result.contacts_b);
}

void PairSorter::release() {
  *this = PairSorter();
}

void PairSorter::groupByQuery(const std::vector<core::Sums>& sums, const OverlappingPairs& found_pairs) {
  assert(found_pairs.count >> 32 == 0);
  first_[0] = 0;
  for (std::size_t q = 0; q < queryCount(); ++q) first_[q + 1] = first_[q] + sums[begin_ + q].pairs;
  order_.resize(found_pairs.count);
  spare_.resize(found_pairs.count);
  if (queryCount() == 1) return std::iota(order_.begin(), order_.end(), 0u);
  cursor_.assign(first_.begin(), first_.end());
  for (std::size_t k = 0; k < found_pairs.count; ++k)
    order_[cursor_[found_pairs.items[k].query - begin_]++] = static_cast<std::uint32_t>(k);
}

void PairSorter::sortGroups(std::span<const PreparedQuery> queries, const OverlappingPairs& found_pairs,
                            Sphere first, Sphere second, Workers& workers) {
  const auto key = [&](Sphere sphere) {
    return [&found_pairs, sphere](std::uint32_t k) { return found_pairs.items[k].*sphere; };
  };
  workers.forRanges(queryCount(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      const auto limit = [&](Sphere sphere) {
        const core::Setup& setup = queries[begin_ + q].setup;
        return sphere == &OverlappingPair::a ? setup.a.count : setup.b.count;
      };
      const std::size_t count = first_[q + 1] - first_[q];
      std::uint32_t *const group = order_.data() + first_[q], *order = group,
                           *spare = spare_.data() + first_[q];
      if (count < kFew) {
        std::sort(group, group + count, [&](std::uint32_t x, std::uint32_t y) {
          const auto keys = [](const OverlappingPair& found, bool a_first) {
            return a_first ? std::pair(found.a, found.b) : std::pair(found.b, found.a);
          };
          return keys(found_pairs.items[x], first == &OverlappingPair::a) <
                 keys(found_pairs.items[y], first == &OverlappingPair::a);
        });
        continue;
      }
      if (second) sortByNumber(order, spare, count, limit(second), key(second));
      sortByNumber(order, spare, count, limit(first), key(first));
      if (order != group) std::copy_n(order, count, group);
    }
  });
}

void PairSorter::writePairs(const OverlappingPairs& found_pairs,
                            QueryResult::Ranges<SpherePair>& pairs) const {
  const std::size_t before = pairs.items.size();
  for (std::size_t q = 0; q < first_.size(); ++q) pairs.first[begin_ + q] = before + first_[q];
  pairs.items.resize(before + order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const OverlappingPair& found = found_pairs.items[order_[k]];
    pairs.items[before + k] = {found.a, found.b};
  }
}

/// Sums the lenses of each sphere with its partners.
void PairSorter::writeContacts(const OverlappingPairs& found_pairs, Sphere sphere, Workers& workers,
                               QueryResult::Ranges<SphereContact>& contacts) {
  heads_.resize(order_.size() + 1);
  std::size_t heads = 0;
  const std::size_t before_all = contacts.items.size();
  for (std::size_t q = 0; q < queryCount(); ++q) {
    contacts.first[begin_ + q] = before_all + heads;
    std::uint32_t before = 0xffffffffu;  // no sphere has this number
    for (std::size_t k = first_[q]; k < first_[q + 1]; ++k) {
      const std::uint32_t here = found_pairs.items[order_[k]].*sphere;
      heads_[heads] = k;
      heads += here != before ? 1 : 0;
      before = here;
    }
  }
  contacts.first[begin_ + queryCount()] = before_all + heads;
  heads_[heads] = order_.size();
  contacts.items.resize(before_all + heads);
  SphereContact* const items = contacts.items.data() + before_all;
  workers.forRanges(heads, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) items[c].sphere = found_pairs.items[order_[heads_[c]]].*sphere;
    cpuKernels().sumContacts(found_pairs.values.data(), order_.data(), heads_.data(), begin, end, items);
  });
}

}  // namespace innersphere
