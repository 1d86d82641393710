#include "finish.hpp"

#include <algorithm>
#include <bit>

#include "core/fixed_sum.hpp"
#include "core/pair.hpp"
#include "digit_sort.hpp"

namespace innersphere {

namespace {

Vec3d toVec(const core::FixedSum* terms, const core::Unit& unit) {
  return {core::toDouble(terms[0], unit), core::toDouble(terms[1], unit), core::toDouble(terms[2], unit)};
}

std::uint32_t high(std::uint64_t key) {
  return static_cast<std::uint32_t>(key >> 32);
}
std::uint32_t low(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}

/// Sums the lenses of one sphere with its partners, keys[0 .. count).
SphereContact sumContact(const PreparedQuery& query, const std::uint64_t* keys, std::size_t count,
                         bool of_b) {
  double volume = 0;
  core::Vec3r moment{0, 0, 0}, area{0, 0, 0};
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t a = of_b ? low(keys[k]) : high(keys[k]), b = of_b ? high(keys[k]) : low(keys[k]);
    const core::Pair pair =
        core::makePair(query.setup.frame, query.setup.a.grid.spheres[query.grid_a->placeOf(a)],
                       query.setup.b.grid.spheres[query.grid_b->placeOf(b)]);
    const core::Contact contact = core::makeContact(pair);
    volume += contact.lens.volume;
    moment = moment + core::lensMoment(pair, contact);
    area = area + contact.lens.rim_area * contact.n;
  }
  const core::Vec3r centroid = volume > 0 ? 1 / volume * moment : core::Vec3r{0, 0, 0};
  SphereContact sum;
  sum.sphere = high(keys[0]);
  sum.volume = static_cast<float>(volume);
  sum.centroid = {static_cast<float>(centroid.x), static_cast<float>(centroid.y),
                  static_cast<float>(centroid.z)};
  sum.area = {static_cast<float>(area.x), static_cast<float>(area.y), static_cast<float>(area.z)};
  return sum;
}

template <typename T>
void clear(QueryResult::Ranges<T>& ranges, std::size_t queries) {
  ranges.items.clear();
  ranges.first.assign(queries + 1, 0);
}

}  // namespace

Overlap toOverlap(const core::Sums& sums, const core::Setup& setup) {
  const core::Units& units = setup.units;
  Overlap overlap;
  overlap.pair_count = sums.pairs;
  overlap.volume = core::toDouble(sums.terms[core::kVolume], units.volume);
  if (overlap.volume > 0) {
    overlap.centroid = toVec(sums.terms + core::kMoment, units.moment);
    for (double& c : overlap.centroid) c /= overlap.volume;
  }
  overlap.force = toVec(sums.terms + core::kForce, units.volume);
  overlap.torque = toVec(sums.terms + core::kTorque, units.torque);
  overlap.area = toVec(sums.terms + core::kArea, units.area);
  overlap.stiffness = core::toDouble(sums.terms[core::kStiffness], units.area);
  overlap.energy = core::toDouble(sums.terms[core::kEnergy], units.energy);
  return overlap;
}

void HitSorter::run(const std::vector<PreparedQuery>& queries, const std::vector<core::Sums>& sums,
                    const Hits& hits, Want want, Workers& workers, QueryResult& result) {
  clear(result.pairs, queries.size());
  clear(result.contacts_a, queries.size());
  clear(result.contacts_b, queries.size());
  if (!wantsHits(want)) return;
  groupByQuery(sums, hits, false);
  sortGroups(queries, false, workers);
  if (want == Want::pairs) return writePairs(result.pairs);
  writeContacts(queries, false, workers, result.contacts_a);
  groupByQuery(sums, hits, true);
  sortGroups(queries, true, workers);
  writeContacts(queries, true, workers, result.contacts_b);
}

void HitSorter::groupByQuery(const std::vector<core::Sums>& sums, const Hits& hits, bool by_b) {
  first_.resize(sums.size() + 1);
  first_[0] = 0;
  for (std::size_t q = 0; q < sums.size(); ++q) first_[q + 1] = first_[q] + sums[q].pairs;
  cursor_.assign(first_.begin(), first_.end());
  keys_.resize(hits.count);
  for (std::size_t k = 0; k < hits.count; ++k) {
    const Hit& hit = hits.items[k];
    keys_[cursor_[hit.query]++] =
        by_b ? std::uint64_t{hit.b} << 32 | hit.a : std::uint64_t{hit.a} << 32 | hit.b;
  }
}

void HitSorter::sortGroups(const std::vector<PreparedQuery>& queries, bool by_b, Workers& workers) {
  constexpr std::size_t kFew = 256;  // are sorted sooner by comparing
  spare_.resize(keys_.size());
  workers.forRanges(first_.size() - 1, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      std::uint64_t* const group = keys_.data() + first_[q];
      const std::size_t count = first_[q + 1] - first_[q];
      if (count < kFew) {
        std::sort(group, group + count);
        continue;
      }
      const int bits_a = std::bit_width(queries[q].setup.a.grid.count - 1);
      const int bits_b = std::bit_width(queries[q].setup.b.grid.count - 1);
      std::uint64_t *keys = group, *spare = spare_.data() + first_[q];
      const auto key = [](std::uint64_t x) { return x; };
      sortByBits(keys, spare, count, key, 0, by_b ? bits_a : bits_b);
      sortByBits(keys, spare, count, key, 32, by_b ? bits_b : bits_a);
      if (keys != group) std::copy_n(keys, count, group);
    }
  });
}

void HitSorter::writePairs(QueryResult::Ranges<SpherePair>& pairs) const {
  pairs.first.assign(first_.begin(), first_.end());
  pairs.items.resize(keys_.size());
  for (std::size_t k = 0; k < keys_.size(); ++k) pairs.items[k] = {high(keys_[k]), low(keys_[k])};
}

void HitSorter::writeContacts(const std::vector<PreparedQuery>& queries, bool of_b, Workers& workers,
                              QueryResult::Ranges<SphereContact>& contacts) {
  heads_.clear();
  for (std::size_t q = 0; q < queries.size(); ++q) {
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
      const PreparedQuery& prepared = queries[static_cast<std::size_t>(query - contacts.first.begin())];
      contacts.items[c] = sumContact(prepared, keys_.data() + heads_[c], heads_[c + 1] - heads_[c], of_b);
    }
  });
}

}  // namespace innersphere
