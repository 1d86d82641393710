#include "pair_cache/packing_search.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Memory is given back if this many searches in a row have needed less than a part of it,
constexpr int kSearchesToLookAt = 64;
constexpr std::size_t kUnused = 4;
/// but not the room for so many contacts of spheres: 512 KB.
constexpr std::size_t kKeptContacts = std::size_t{1} << 14;

std::size_t roomOf(const QueryResult& result) {
  return result.contacts_a.items.capacity() + result.contacts_b.items.capacity();
}

}  // namespace

PackingSearch::PackingSearch(const ContactOptions& options, std::size_t room)
    : backend_(options.backend), queue_(options.queue), context_(QueryContextOptions{backend_, 0}) {
  reserve(room);
}

void PackingSearch::reserve(std::size_t pairs) {
  items_.reserve(pairs);
  queried_.reserve(pairs);
  queries_.reserve(pairs);
}

void PackingSearch::clear() {
  items_.clear();
  queried_.clear();
  queries_.clear();
  started_ = false;
}

void PackingSearch::start(Estimator estimator) {
  estimator_ = estimator;
  if (queue_) return;
  makeQueries(SearchPass::surfaces);
  if (queries_.empty()) return;
  context_.start(queries_.data(), queries_.size(), queryOptionsOf(SearchPass::surfaces, estimator));
  started_ = true;
}

void PackingSearch::run(SearchPass pass) {
  const QueryOptions options = queryOptionsOf(pass, estimator_);
  if (queue_)
    queue_->run(queries_.data(), queries_.size(), options, result_);
  else
    context_.run(queries_.data(), queries_.size(), options, result_);
}

Overlap PackingSearch::overlap(const PairQuery& query, Estimator estimator) {
  const QueryOptions options{Want::wrench, estimator};
  if (!queue_) return context_.overlap(query, options);
  queue_->run(&query, 1, options, result_);
  return result_.overlaps[0];
}

bool PackingSearch::isLarge() const {
  return roomOf(result_) > kKeptContacts && context_.lastBackend() == Backend::cpu;
}

void PackingSearch::releaseUnused() {
  if (++searches_ < kSearchesToLookAt) return;
  if (roomOf(result_) > std::max(kKeptContacts, kUnused * most_contacts_)) result_ = QueryResult();
  most_contacts_ = 0;
  searches_ = 0;
}

void PackingSearch::makeQueries(SearchPass pass) {
  queried_.clear();
  for (Item& item : items_) {
    if (item.pass == pass) queried_.push_back(&item);
  }
  queries_.resize(queried_.size());
  inParallel(queried_.size(), [&](std::size_t i) { queries_[i] = queried_[i]->pair->makeQuery(pass); });
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
