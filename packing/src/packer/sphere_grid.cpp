#include "packer/sphere_grid.hpp"

#include <algorithm>
#include <cmath>

#include "common/hash.hpp"

namespace innersphere {

SphereGrid::SphereGrid() : slots_(1024) {}

SphereGrid::SphereGrid(std::span<const Ball> balls) : SphereGrid() {
  for (const Ball& ball : balls) insert(ball);
}

int SphereGrid::levelOf(double radius) {
  int level = 0;
  while (level + 1 < kLevels && 2 * radius * (2 << level) <= 1) ++level;
  return level;
}

std::int64_t SphereGrid::coordinate(double x, int level) {
  const std::int64_t cells = std::int64_t{1} << level;
  const double scaled = std::clamp(x, 0.0, 1.0) * static_cast<double>(cells);
  return std::min(static_cast<std::int64_t>(scaled), cells - 1);
}

std::uint64_t SphereGrid::keyOf(int level, std::int64_t x, std::int64_t y, std::int64_t z) {
  return (((static_cast<std::uint64_t>(level) << 19 | static_cast<std::uint64_t>(x)) << 19 |
           static_cast<std::uint64_t>(y))
          << 19) |
         static_cast<std::uint64_t>(z);
}

SphereGrid::Slot& SphereGrid::slot(std::uint64_t key) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = mixed(key) & mask;
  while (slots_[i].head != kNone && slots_[i].key != key) i = (i + 1) & mask;
  return slots_[i];
}

std::uint32_t SphereGrid::head(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = mixed(key) & mask;
  while (slots_[i].head != kNone && slots_[i].key != key) i = (i + 1) & mask;
  return slots_[i].head;
}

void SphereGrid::grow() {
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  for (const Slot& s : old) {
    if (s.head != kNone) slot(s.key) = s;
  }
}

void SphereGrid::insert(const Ball& ball) {
  if (2 * used_ >= slots_.size()) grow();
  const int level = levelOf(ball.radius);
  const auto index = static_cast<std::uint32_t>(balls_.size());
  Slot& s = slot(keyOf(level, coordinate(ball.centre[0], level), coordinate(ball.centre[1], level),
                       coordinate(ball.centre[2], level)));
  if (s.head == kNone) {
    s.key = keyOf(level, coordinate(ball.centre[0], level), coordinate(ball.centre[1], level),
                  coordinate(ball.centre[2], level));
    ++used_;
  }
  balls_.push_back(ball);
  next_.push_back(s.head);
  s.head = index;
  by_level_[level].push_back(index);
}

SphereGrid::Nearest SphereGrid::nearest(const Point& x, double cutoff) const {
  Nearest best;
  double limit = cutoff;
  visitNear(x, x, cutoff, [&](std::uint32_t i) {
    const double distance = balls_[i].distance(x);
    if (distance < limit || (distance == limit && i < best.index)) {
      limit = distance;
      best = {distance, i};
    }
  });
  return best;
}

}  // namespace innersphere
