#include "cpu/hit_sorter.hpp"

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
void clear(QueryResult::Ranges<T>& ranges, std::size_t queries) {
  ranges.items.clear();
  ranges.first.assign(queries + 1, 0);
}

}  // namespace

void HitSorter::run(const std::vector<PreparedQuery>& queries, const std::vector<core::Sums>& sums,
                    const Hits& hits, Want want, Workers& workers, QueryResult& result) {
  clear(result.pairs, queries.size());
  clear(result.contacts_a, queries.size());
  clear(result.contacts_b, queries.size());
  if (!wantsHits(want)) return;
  groupByQuery(sums, hits);
  sortGroups(queries, hits, &Hit::a, &Hit::b, workers);
  if (want == Want::pairs) return writePairs(hits, result.pairs);
  writeContacts(hits, &Hit::a, workers, result.contacts_a);
  if (want == Want::contacts_of_a) return;
  sortGroups(queries, hits, &Hit::b, nullptr, workers);
  writeContacts(hits, &Hit::b, workers, result.contacts_b);
}

void HitSorter::groupByQuery(const std::vector<core::Sums>& sums, const Hits& hits) {
  assert(hits.count >> 32 == 0);
  first_.resize(sums.size() + 1);
  first_[0] = 0;
  for (std::size_t q = 0; q < sums.size(); ++q) first_[q + 1] = first_[q] + sums[q].pairs;
  order_.resize(hits.count);
  spare_.resize(hits.count);
  if (sums.size() == 1) return std::iota(order_.begin(), order_.end(), 0u);
  cursor_.assign(first_.begin(), first_.end());
  for (std::size_t k = 0; k < hits.count; ++k)
    order_[cursor_[hits.items[k].query]++] = static_cast<std::uint32_t>(k);
}

void HitSorter::sortGroups(const std::vector<PreparedQuery>& queries, const Hits& hits, Sphere first,
                           Sphere second, Workers& workers) {
  const auto key = [&](Sphere sphere) {
    return [&hits, sphere](std::uint32_t k) { return hits.items[k].*sphere; };
  };
  workers.forRanges(queries.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      const auto limit = [&](Sphere sphere) {
        return sphere == &Hit::a ? queries[q].setup.a.grid.count : queries[q].setup.b.grid.count;
      };
      const std::size_t count = first_[q + 1] - first_[q];
      std::uint32_t *const group = order_.data() + first_[q], *order = group,
                           *spare = spare_.data() + first_[q];
      if (count < kFew) {
        std::sort(group, group + count, [&](std::uint32_t x, std::uint32_t y) {
          const auto keys = [](const Hit& hit, bool a_first) {
            return a_first ? std::pair(hit.a, hit.b) : std::pair(hit.b, hit.a);
          };
          return keys(hits.items[x], first == &Hit::a) < keys(hits.items[y], first == &Hit::a);
        });
        continue;
      }
      if (second) sortByNumber(order, spare, count, limit(second), key(second));
      sortByNumber(order, spare, count, limit(first), key(first));
      if (order != group) std::copy_n(order, count, group);
    }
  });
}

void HitSorter::writePairs(const Hits& hits, QueryResult::Ranges<SpherePair>& pairs) const {
  pairs.first.assign(first_.begin(), first_.end());
  pairs.items.resize(order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Hit& hit = hits.items[order_[k]];
    pairs.items[k] = {hit.a, hit.b};
  }
}

/// Sums the lenses of each sphere with its partners.
void HitSorter::writeContacts(const Hits& hits, Sphere sphere, Workers& workers,
                              QueryResult::Ranges<SphereContact>& contacts) {
  heads_.resize(order_.size() + 1);
  std::size_t heads = 0;
  for (std::size_t q = 0; q + 1 < first_.size(); ++q) {
    contacts.first[q] = heads;
    std::uint32_t before = 0xffffffffu;  // no sphere has this number
    for (std::size_t k = first_[q]; k < first_[q + 1]; ++k) {
      const std::uint32_t here = hits.items[order_[k]].*sphere;
      heads_[heads] = k;
      heads += here != before ? 1 : 0;
      before = here;
    }
  }
  contacts.first.back() = heads;
  heads_[heads] = order_.size();
  contacts.items.resize(heads);
  workers.forRanges(heads, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      contacts.items[c].sphere = hits.items[order_[heads_[c]]].*sphere;
    cpuKernels().sumContacts(hits.values.data(), order_.data(), heads_.data(), begin, end,
                             contacts.items.data());
  });
}

}  // namespace innersphere
