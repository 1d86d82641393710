#include "packer/dual_simplex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace innersphere {
namespace {

// Digits of a function that count. The solid's distances carry rounding errors that depend on its size and
// place; without them, the search takes the same way for all sizes and places, also where two ways are
// equally good.
constexpr double kDigits = 0x1p22;

double rounded(double x, double unit) {
  return std::nearbyint(x / unit * kDigits) * unit / kDigits;
}

}  // namespace

void DualSimplex::restart(double half) {
  unit_ = std::ldexp(1.0, std::ilogb(half));
  rows_.resize(kFaces);
  for (int k = 0; k < kFaces; ++k) {
    rows_[k] = {Eigen::Vector4d::Zero(), half};
    rows_[k].normal[1 + k / 2] = k % 2 ? -1 : 1;
  }
}

void DualSimplex::add(double value, const Point& gradient) {
  const auto slope = [&](int k) { return -rounded(gradient[k], 1); };
  rows_.push_back({Eigen::Vector4d(1, slope(0), slope(1), slope(2)), rounded(value, unit_)});
  if (size() == 1) {
    start();
    return;
  }
  // Each pivot lowers the optimum; the cap only guards against rounding.
  const double tolerance = 1e-13;
  for (int pivots = 0; pivots < 64; ++pivots) {
    int worst = -1;
    double excess = tolerance;
    for (int k = 0; k < static_cast<int>(rows_.size()); ++k) {
      const double e = rows_[k].excess(optimum_);
      if (e > excess) {
        excess = e;
        worst = k;
      }
    }
    if (worst < 0) return;
    enter(worst);
  }
}

void DualSimplex::start() {
  // Each face that the function rises to: the matrix of the normals is its own inverse, but for signs.
  const Row& first = rows_[kFaces];
  basis_[0] = kFaces;
  inverse_.setZero();
  inverse_(0, 0) = 1;
  for (int k = 1; k < 4; ++k) {
    const bool rises = first.normal[k] <= 0;
    basis_[k] = 2 * (k - 1) + (rises ? 0 : 1);
    inverse_(k, k) = rises ? 1 : -1;
    inverse_(0, k) = std::abs(first.normal[k]);
  }
  findOptimum();
}

void DualSimplex::enter(int row) {
  // The new normal as a combination of the basis; the first dual variable that it drives to zero leaves.
  const Eigen::RowVector4d mix = rows_[row].normal.transpose() * inverse_;
  int leaving = -1;
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 4; ++i) {
    if (mix[i] < 1e-12) continue;
    const double ratio = inverse_(0, i) / mix[i];
    if (ratio < smallest) {
      smallest = ratio;
      leaving = i;
    }
  }
  if (leaving < 0) return;
  const Eigen::Vector4d column = inverse_.col(leaving) / mix[leaving];
  for (int i = 0; i < 4; ++i) {
    if (i != leaving) inverse_.col(i) -= mix[i] * column;
  }
  inverse_.col(leaving) = column;
  basis_[leaving] = row;
  findOptimum();
}

void DualSimplex::findOptimum() {
  Eigen::Vector4d bounds;
  for (int i = 0; i < 4; ++i) bounds[i] = rows_[basis_[i]].bound;
  optimum_ = inverse_ * bounds;
}

}  // namespace innersphere
