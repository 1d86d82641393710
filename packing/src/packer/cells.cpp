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

RadiusSchedule::RadiusSchedule(double first, double last, double ratio) {
  assert(first >= last && last > 0 && ratio > 1);
  for (double radius = first; radius > last; radius /= ratio) radii_.push_back(static_cast<float>(radius));
  const float end = std::nextafter(static_cast<float>(last), 1.0f);
  while (!radii_.empty() && radii_.back() <= end) radii_.pop_back();
  radii_.push_back(end);
}

std::size_t RadiusSchedule::below(float radius) const {
  const auto it = std::lower_bound(radii_.begin(), radii_.end(), radius, std::greater<>());
  // `it` is the first step that is not larger than the radius.
  const auto step = static_cast<std::size_t>(it - radii_.begin());
  if (step < radii_.size() && radii_[step] == radius) return step;
  return step == 0 ? 0 : step - 1;
}

void CellQueue::push(const Cell& cell) {
  if (cell.upper <= schedule_[schedule_.size() - 1]) return;
  buckets_[schedule_.below(cell.upper)].push_back(cell);
  ++live_;
}

std::size_t CellQueue::top() const {
  std::size_t step = 0;
  while (step < buckets_.size() && buckets_[step].empty()) ++step;
  return step;
}

std::size_t CellQueue::countAbove(std::size_t until) const {
  std::size_t count = 0;
  for (std::size_t step = 0; step < std::min(until, buckets_.size()); ++step) count += buckets_[step].size();
  return count;
}

std::vector<Cell> CellQueue::takeAbove(std::size_t until) {
  std::vector<Cell> taken;
  for (std::size_t step = 0; step < std::min(until, buckets_.size()); ++step) {
    taken.insert(taken.end(), buckets_[step].begin(), buckets_[step].end());
    std::vector<Cell>().swap(buckets_[step]);
  }
  live_ -= taken.size();
  return taken;
}

}  // namespace innersphere
