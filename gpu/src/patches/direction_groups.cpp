#include "patches/direction_groups.hpp"

#include <algorithm>
#include <cmath>

#include "cpu/kernels.hpp"
#include "cpu/simd.hpp"

namespace innersphere {

namespace {

Vec3f unit(const Vec3d& v) {
  const double inverse = 1 / std::sqrt(dot(v, v));
  return {static_cast<float>(inverse * v.x), static_cast<float>(inverse * v.y),
          static_cast<float>(inverse * v.z)};
}

}  // namespace

void DirectionGroups::clear(std::size_t most) {
  const std::size_t room = (most + kLanes - 1) / kLanes * kLanes;
  if (vectors_.size() < room) {
    for (std::vector<float>* column : {&x_, &y_, &z_}) column->resize(room);
    vectors_.resize(room);
    bin_.resize(room);
    groups_.resize(room);
  }
  count_ = 0;
}

std::uint32_t DirectionGroups::group(double max_angle) {
  sumBins(max_angle);
  makeDirections(max_angle);
  // Once more with the final directions, so that none is held by where a group began.
  cpuKernels().nearestDirections(x_.data(), y_.data(), z_.data(), count_, directions_.data(),
                                 directions_.size(), groups_.data());
  return static_cast<std::uint32_t>(directions_.size());
}

/// Bins are squares of an octahedron that is unfolded into one square; about half of the angle wide.
void DirectionGroups::sumBins(double max_angle) {
  const int side = static_cast<int>(std::clamp(4 / max_angle, 4.0, 64.0));
  const float scale = 0.5f * static_cast<float>(side), most = static_cast<float>(side - 1);
  const std::size_t count = count_;
  const float *const x = x_.data(), *const y = y_.data(), *const z = z_.data();
  std::uint32_t* const bins = bin_.data();
  for (std::size_t k = 0; k < count; ++k) {
    const float inverse = 1 / (std::fabs(x[k]) + std::fabs(y[k]) + std::fabs(z[k]));
    const float u = inverse * x[k], v = inverse * y[k];
    const float folded_u = std::copysign(1 - std::fabs(v), u), folded_v = std::copysign(1 - std::fabs(u), v);
    const float column = (1 + (z[k] < 0 ? folded_u : u)) * scale,
                row = (1 + (z[k] < 0 ? folded_v : v)) * scale;
    const auto i = static_cast<int>(column < most ? column : most),
               j = static_cast<int>(row < most ? row : most);
    bins[k] = static_cast<std::uint32_t>(j * side + i);
  }
  sums_.assign(static_cast<std::size_t>(side * side), {0, 0, 0});
  for (std::size_t k = 0; k < count; ++k) sums_[bins[k]] = sums_[bins[k]] + vectors_[k];
  bins_.clear();
  for (const Vec3d& sum : sums_) {
    const double length2 = dot(sum, sum);
    if (length2 > 0) bins_.push_back({sum, length2});
  }
}

void DirectionGroups::makeDirections(double max_angle) {
  // Equal ones in the order of their sums, so that the order is always the same.
  std::sort(bins_.begin(), bins_.end(), [](const Bin& a, const Bin& b) {
    if (a.length2 != b.length2) return a.length2 > b.length2;
    const Vec3d &s = a.sum, &t = b.sum;
    return s.x != t.x ? s.x > t.x : s.y != t.y ? s.y > t.y : s.z > t.z;
  });
  const auto least = static_cast<float>(std::cos(max_angle));
  group_sums_.clear();
  directions_.clear();
  for (const Bin& bin : bins_) {
    const Vec3f direction = unit(bin.sum);
    float best = least;
    std::size_t group = directions_.size();
    for (std::size_t g = 0; g < directions_.size(); ++g) {
      const float cosine = dot(direction, directions_[g]);
      group = cosine > best ? g : group;
      best = cosine > best ? cosine : best;
    }
    if (group == directions_.size()) {
      directions_.push_back(direction);
      group_sums_.push_back(bin.sum);
    } else {
      group_sums_[group] = group_sums_[group] + bin.sum;
      directions_[group] = unit(group_sums_[group]);
    }
  }
}

}  // namespace innersphere
