#include "pair_cache/packing_search.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

PackingSearch::PackingSearch(Backend backend, std::size_t room)
    : backend_(backend), context_(QueryContextOptions{backend, 0}) {
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
  makeQueries(SearchPass::surfaces);
  if (queries_.empty()) return;
  context_.start(queries_.data(), queries_.size(), queryOptionsOf(SearchPass::surfaces, estimator));
  started_ = true;
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
