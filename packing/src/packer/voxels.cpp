#include "packer/voxels.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "packer/clearance_cache.hpp"
#include "packer/jitter.hpp"
#include "surface/lanes.hpp"

namespace innersphere {
namespace {

// Cells along an edge of the unit cube, at most: 17 MB of bits.
constexpr double kMostCells = 512;

// Cells along an edge of the blocks that are looked at as a whole.
constexpr std::uint32_t kBlock = 8;
static_assert(kBlock == 8, "a row of a block is a byte of the bitmap");

}  // namespace

Voxels::Voxels(const Container& container, double volume, double wanted) {
  spacing_ = std::max(std::cbrt(volume / wanted), 1 / kMostCells);
  reach_ = std::sqrt(3.0) / 2 * kBlock * spacing_;
  const Bounds box = container.solid().bounds();
  origin_ = container.fromWorld(box.min);
  const Point size = container.fromWorld(box.max) - origin_;
  for (int k = 0; k < 3; ++k) {
    blocks_in_[k] = static_cast<std::uint32_t>(size[k] / (spacing_ * kBlock)) + 1;
    size_[k] = blocks_in_[k] * kBlock;
  }
  const auto place = [&](const Index& at) {
    const Point x(at[0] + jitter(at, 0), at[1] + jitter(at, 1), at[2] + jitter(at, 2));
    return Point(origin_ + x * spacing_);
  };
  const auto cell = [&](std::size_t block, std::uint32_t i) {
    const auto b = static_cast<std::uint32_t>(block);
    return Index{b % blocks_in_[0] * kBlock + i % kBlock,
                 b / blocks_in_[0] % blocks_in_[1] * kBlock + i / kBlock % kBlock,
                 b / (blocks_in_[0] * blocks_in_[1]) * kBlock + i / (kBlock * kBlock)};
  };
  constexpr std::uint32_t kCells = kBlock * kBlock * kBlock;

  blocks_.resize(std::size_t{blocks_in_[0]} * blocks_in_[1] * blocks_in_[2]);
  inside_.resize(blocks_.size() * kBlock * kBlock);
  // A row of blocks at a time: the side of a block mostly follows from the one before.
  tbb::parallel_for(std::size_t{0}, blocks_.size() / blocks_in_[0], [&](std::size_t row) {
    ClearanceCache clearances(container.margin());
    for (std::size_t b = row * blocks_in_[0]; b < (row + 1) * blocks_in_[0]; ++b) {
      const Index first = cell(b, 0);
      Block& block = blocks_[b];
      block.centre =
          origin_ + (Point(first[0], first[1], first[2]) + Point::Constant(kBlock / 2.0)) * spacing_;
      const double cutoff = 4 * reach_;
      block.distance = clearances.signedDistance(container, block.centre, cutoff);
      if (block.distance <= -reach_) continue;
      ClearanceCache near(container.margin());
      near.add(block.centre, block.distance);
      for (std::uint32_t i = 0; i < kCells; ++i) {
        const Index at = cell(b, i);
        if (block.distance >= reach_ || near.contains(container, place(at), cutoff)) setInside(bit(at));
      }
    }
  });

  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    if (block.distance <= -reach_) continue;
    Run run{block.centre, {points_[0].size(), points_[1].size()}};
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const Index at = cell(b, i);
      if (isInside(bit(at))) points_[(at[0] + at[1] + at[2]) % 2].push_back(place(at).cast<float>());
    }
    run.end = {points_[0].size(), points_[1].size()};
    if (run.end != run.begin) runs_.push_back(run);
  }
}

const Voxels::Block* Voxels::blockAt(const Point& x) const {
  const Point at = (x - origin_) / (spacing_ * kBlock);
  for (int k = 0; k < 3; ++k) {
    if (!(at[k] >= 0 && at[k] < blocks_in_[k])) return nullptr;
  }
  const auto z = static_cast<std::size_t>(at[2]), y = static_cast<std::size_t>(at[1]);
  return &blocks_[(z * blocks_in_[1] + y) * blocks_in_[0] + static_cast<std::size_t>(at[0])];
}

Point Voxels::point(double part) const {
  const auto& points = points_[points_[0].size() < points_[1].size()];
  return points[static_cast<std::size_t>(part * static_cast<double>(points.size()))].cast<double>();
}

Voxels::Shared Voxels::shared(const Pose& pose) const {
  // Into the lattice of the original; in single precision, which is far finer than the cells. All axes side
  // by side, and a last number that is always 0.
  FourFloats columns[4]{}, sizes{0, 0, 0, 1};
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) columns[i][k] = static_cast<float>(pose.rotation(k, i) / spacing_);
    columns[3][k] = static_cast<float>((pose.shift - origin_)[k] / spacing_);
    sizes[k] = static_cast<float>(size_[k]);
  }
  const Point extent = Point(size_[0], size_[1], size_[2]) * spacing_;
  const auto hit = [&](const Eigen::Vector3f& point) {
    const float* const x = point.data();
    const FourFloats along = columns[0] * x[0] + columns[1] * x[1] + columns[2] * x[2] + columns[3];
    if (signBits((along >= FourFloats{}) & (along < sizes)) != 15) return false;
    const FourInts at = __builtin_convertvector(along, FourInts);
    return isInside(bit({static_cast<std::uint32_t>(at[0]), static_cast<std::uint32_t>(at[1]),
                         static_cast<std::uint32_t>(at[2])}));
  };
  std::size_t hits[2] = {};
  for (const Run& run : runs_) {
    const Point centre = pose.apply(run.centre), corner = centre - origin_;
    if ((corner.array() < -reach_).any() || ((extent - corner).array() < -reach_).any()) continue;
    const Block* there = blockAt(centre);
    const double clear = there ? std::abs(there->distance) - (centre - there->centre).norm() - reach_ : 0;
    // Cells are rounded to one side or the other within a cell's diagonal of the surface.
    if (clear > std::sqrt(3.0) * spacing_) {
      for (int half = 0; there->distance > 0 && half < 2; ++half)
        hits[half] += run.end[half] - run.begin[half];
      continue;
    }
    for (int half = 0; half < 2; ++half) {
      for (std::size_t i = run.begin[half]; i < run.end[half]; ++i) hits[half] += hit(points_[half][i]);
    }
  }
  double fraction[2] = {};
  for (int half = 0; half < 2; ++half) {
    const std::size_t looked = points_[half].size();
    if (looked > 0) fraction[half] = static_cast<double>(hits[half]) / static_cast<double>(looked);
  }
  return {(fraction[0] + fraction[1]) / 2, std::abs(fraction[0] - fraction[1]) / 2};
}

}  // namespace innersphere
