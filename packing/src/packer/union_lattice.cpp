#include "packer/union_lattice.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "packer/clearance_cache.hpp"

namespace innersphere {
namespace {

// The weight of a cell that is wholly inside. Weights are whole numbers, so that their sums are exact.
constexpr std::int32_t kWholeCell = 64;

// Cells, at most: 140 MB.
constexpr double kMostCellsInAll = 1 << 24;

// Cells around the solid. Beyond them a ball pays for the outside even where others hold it.
constexpr int kCellsAround = 4;
constexpr std::ptrdiff_t kBeyond = -1;

}  // namespace

UnionLattice::UnionLattice(const Container& container, double spacing, double outside_weight)
    : container_(container), outside_(static_cast<std::int32_t>(std::lround(-kWholeCell * outside_weight))) {
  const Bounds box = container.solid().bounds();
  const Point low = container.fromWorld(box.min), high = container.fromWorld(box.max);
  for (spacing_ = spacing;; spacing_ *= 1.25) {
    double cells = 1;
    for (int k = 0; k < 3; ++k) cells *= std::ceil((high[k] - low[k]) / spacing_) + 2 * kCellsAround;
    if (cells <= kMostCellsInAll) break;
  }
  for (int k = 0; k < 3; ++k) {
    size_[k] = static_cast<Index>(std::ceil((high[k] - low[k]) / spacing_)) + 2 * kCellsAround;
    origin_[k] = (low[k] + high[k] - static_cast<double>(size_[k]) * spacing_) / 2;
  }
  const Index rows = size_[1] * size_[2];
  weights_.resize(static_cast<std::size_t>(rows * size_[0]));
  holding_.resize(weights_.size());
  sums_.resize(static_cast<std::size_t>(rows * (size_[0] + 1)));
  tbb::parallel_for(Index{0}, rows, [&](Index row) {
    ClearanceCache clearances(container_.margin());
    const auto weights = weights_.begin() + row * size_[0];
    for (Index x = 0; x < size_[0];) {
      const double distance = clearances.signedDistance(container_, centreOf(row, x), 2);
      const double part = std::clamp(0.5 + distance / spacing_, 0.0, 1.0);
      // The cells that the surface keeps away from are on the same side.
      const Index end =
          std::min(x + std::max(Index{1}, static_cast<Index>(std::abs(distance) / spacing_ - 0.5)), size_[0]);
      std::fill(weights + x, weights + end,
                outside_ + static_cast<std::int32_t>(std::lround(part * (kWholeCell - outside_))));
      x = end;
    }
    sumRow(row);
  });
}

Point UnionLattice::centreOf(Index row, Index x) const {
  const auto along = [](Index i) { return static_cast<double>(i) + 0.5; };
  return origin_ + spacing_ * Point(along(x), along(row % size_[1]), along(row / size_[1]));
}

bool UnionLattice::isInside(std::size_t cell) const {
  return 2 * weights_[cell] > kWholeCell + outside_;
}

void UnionLattice::sumRow(Index row) {
  const std::int32_t* const weights = weights_.data() + row * size_[0];
  const std::uint16_t* const holding = holding_.data() + row * size_[0];
  std::int32_t* const sums = sums_.data() + row * (size_[0] + 1);
  std::int32_t sum = 0;
  for (Index x = 0; x < size_[0]; ++x) {
    sums[x] = sum;
    if (holding[x] == 0) sum += weights[x];
  }
  sums[size_[0]] = sum;
}

/// Calls visit(row, from, to) with the ends along x, in cells, of what each row has in the ball. Rows beyond
/// the lattice are kBeyond.
template <typename Visit>
void UnionLattice::visitRows(const Ball& ball, const Visit& visit) const {
  const Point centre = (ball.centre - origin_) / spacing_;
  const double radius = ball.radius / spacing_;
  const auto first = [&](int axis) { return std::ceil(centre[axis] - radius - 0.5) + 0.5; };
  for (double z = first(2); z < centre[2] + radius; ++z) {
    for (double y = first(1); y < centre[1] + radius; ++y) {
      const double dz = z - centre[2], dy = y - centre[1];
      const double squared = radius * radius - dz * dz - dy * dy;
      if (squared <= 0) continue;
      const double half = std::sqrt(squared);
      const auto row_y = static_cast<Index>(std::floor(y)), row_z = static_cast<Index>(std::floor(z));
      const bool within = row_y >= 0 && row_y < size_[1] && row_z >= 0 && row_z < size_[2];
      visit(within ? row_z * size_[1] + row_y : kBeyond, centre[0] - half, centre[0] + half);
    }
  }
}

double UnionLattice::gain(const Ball& ball) const {
  const double outside = outside_, end = static_cast<double>(size_[0]);
  double sum = 0;
  visitRows(ball, [&](Index row, double from, double to) {
    if (row == kBeyond) {
      sum += (to - from) * outside;
      return;
    }
    const std::int32_t* const sums = sums_.data() + row * (size_[0] + 1);
    const auto upTo = [&](double x) {
      if (x <= 0) return x * outside;
      if (x >= end) return sums[size_[0]] + (x - end) * outside;
      const auto cell = static_cast<Index>(x);
      return sums[cell] + (x - static_cast<double>(cell)) * (sums[cell + 1] - sums[cell]);
    };
    sum += upTo(to) - upTo(from);
  });
  return sum / kWholeCell;
}

void UnionLattice::change(const Ball& ball, int by) {
  visitRows(ball, [&](Index row, double from, double to) {
    if (row == kBeyond) return;
    std::uint16_t* const holding = holding_.data() + row * size_[0];
    const Index first = std::max(static_cast<Index>(std::ceil(from - 0.5)), Index{0});
    const Index last = std::min(static_cast<Index>(std::floor(to - 0.5)), size_[0] - 1);
    for (Index x = first; x <= last; ++x) holding[x] = static_cast<std::uint16_t>(holding[x] + by);
    sumRow(row);
  });
}

std::vector<Ball> UnionLattice::innerBalls(double wanted) const {
  std::size_t inside = 0;
  for (std::size_t cell = 0; cell < weights_.size(); ++cell) inside += isInside(cell);
  const Index stride =
      std::max(Index{1}, static_cast<Index>(std::cbrt(static_cast<double>(inside) / wanted)));
  std::vector<Ball> balls;
  for (Index z = stride / 2; z < size_[2]; z += stride) {
    for (Index y = stride / 2; y < size_[1]; y += stride) {
      const Index row = z * size_[1] + y;
      for (Index x = stride / 2; x < size_[0]; x += stride) {
        if (isInside(static_cast<std::size_t>(row * size_[0] + x))) balls.push_back({centreOf(row, x), 0});
      }
    }
  }
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
    balls[i].radius = container_.closest(balls[i].centre, std::numeric_limits<double>::infinity()).distance;
  });
  return balls;
}

}  // namespace innersphere
