#include "packer/cells.hpp"

#include <algorithm>
#include <cassert>
#include <functional>

namespace innersphere {

Cell Cell::child(int octant) const {
  Cell half = *this;
  for (int k = 0; k < 3; ++k) half.at[k] = 2 * at[k] + (octant >> k & 1);
  half.level = static_cast<std::uint8_t>(level + 1);
  return half;
}

std::uint64_t mortonCode(const Cell& cell, int level) {
  std::uint64_t code = 0;
  for (int bit = level - 1; bit >= 0; --bit) {
    const int shift = bit + static_cast<int>(cell.level) - level;
    for (int k = 2; k >= 0; --k) code = code << 1 | (shift >= 0 ? cell.at[k] >> shift & 1u : 0u);
  }
  return code;
}

Ladder::Ladder(double first, double last, double ratio) {
  assert(first >= last && last > 0 && ratio > 1);
  for (double radius = first; radius > last; radius /= ratio) rungs_.push_back(static_cast<float>(radius));
  const float end = std::nextafter(static_cast<float>(last), 1.0f);
  while (!rungs_.empty() && rungs_.back() <= end) rungs_.pop_back();
  rungs_.push_back(end);
}

std::size_t Ladder::below(float radius) const {
  const auto it = std::lower_bound(rungs_.begin(), rungs_.end(), radius, std::greater<>());
  // `it` is the first rung that is not larger than the radius.
  const auto rung = static_cast<std::size_t>(it - rungs_.begin());
  if (rung < rungs_.size() && rungs_[rung] == radius) return rung;
  return rung == 0 ? 0 : rung - 1;
}

void CellQueue::push(const Cell& cell) {
  if (cell.upper <= ladder_[ladder_.size() - 1]) return;
  buckets_[ladder_.below(cell.upper)].push_back(cell);
  ++live_;
}

std::size_t CellQueue::top() const {
  std::size_t rung = 0;
  while (rung < buckets_.size() && buckets_[rung].empty()) ++rung;
  return rung;
}

std::size_t CellQueue::countAbove(std::size_t until) const {
  std::size_t count = 0;
  for (std::size_t rung = 0; rung < std::min(until, buckets_.size()); ++rung) count += buckets_[rung].size();
  return count;
}

std::vector<Cell> CellQueue::takeAbove(std::size_t until) {
  std::vector<Cell> taken;
  for (std::size_t rung = 0; rung < std::min(until, buckets_.size()); ++rung) {
    taken.insert(taken.end(), buckets_[rung].begin(), buckets_[rung].end());
    std::vector<Cell>().swap(buckets_[rung]);
  }
  live_ -= taken.size();
  return taken;
}

}  // namespace innersphere
