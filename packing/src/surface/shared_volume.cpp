#include "surface/shared_volume.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace innersphere {

namespace {

using core::Mat3;

/// Less than this, relative to the sum of absolute values, is what rounding leaves of no volume at all.
constexpr double kRounding = 1e-12;

/// Returns a frame whose z is near `up`. It leans a little in no special direction, so that the walls
/// of bodies that stand straight on each other are not seen from their edges.
Mat3<double> columnFrame(const Vec3d& up) {
  constexpr double kLean[] = {0.0113, 0.0071};
  const double length = norm(up);
  Vec3d z = length > 0 ? (1 / length) * up : Vec3d{0, 0, 1};
  const Vec3d other = std::abs(z.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  Vec3d x = cross(other, z);
  x = (1 / norm(x)) * x;
  z = z + kLean[0] * x + kLean[1] * cross(z, x);
  z = (1 / norm(z)) * z;
  Vec3d y = cross(z, x);
  y = (1 / norm(y)) * y;
  x = cross(y, z);
  return {{x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z}};
}

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Returns whether a column may reach from `a` down to `b`.
bool isAbove(const Bounds& a, const Bounds& b) {
  return b.min.z < a.max.z && b.min.x < a.max.x && a.min.x < b.max.x && b.min.y < a.max.y &&
         a.min.y < b.max.y;
}

double width(const Bounds& box) {
  return box.max.x - box.min.x + box.max.y - box.min.y;
}

/// Returns a box that holds all that A and B share: it loses on its sides what is outside of one of them, in
/// turns, for as long as that makes it much smaller.
Bounds sharedBox(const SurfaceView& a, const SurfaceView& b) {
  constexpr double kMuchSmaller = 0.7;
  Bounds box = common(a.bounds(), b.bounds());
  for (double before = 2 * width(box); !isEmpty(box) && width(box) < kMuchSmaller * before;) {
    before = width(box);
    box = a.shrunk(box);
    if (!isEmpty(box)) box = b.shrunk(box);
  }
  return box;
}

/// Sorts triangles into square cells, to find those that lie above or below another.
class ColumnGrid {
 public:
  ColumnGrid(const std::vector<ColumnTriangle>& triangles, const Bounds& box) : box_(box) {
    const double sizes[] = {box.max.x - box.min.x, box.max.y - box.min.y};
    const auto count = static_cast<double>(triangles.size());
    const double side = std::sqrt(sizes[0] * sizes[1] / count);
    for (int k = 0; k < 2; ++k) {
      count_[k] = side > 0 ? static_cast<int>(std::clamp(sizes[k] / side, 1.0, count)) : 1;
      per_length_[k] = sizes[k] > 0 ? count_[k] / sizes[k] : 0;
    }
    first_.assign(static_cast<std::size_t>(count_[0]) * count_[1] + 1, 0);
    for (const ColumnTriangle& t : triangles)
      forCells(cellsOf(t.box), [&](std::size_t cell, int, int) { ++first_[cell]; });
    std::uint32_t end = 0;
    for (std::uint32_t& first : first_) first = end += first;
    members_.resize(end);
    for (std::size_t i = triangles.size(); i-- > 0;) {
      const Cells cells = cellsOf(triangles[i].box);
      forCells(cells, [&](std::size_t cell, int, int) {
        members_[--first_[cell]] = {&triangles[i], cells.first[0], cells.first[1]};
      });
    }
  }

  /// Calls f(triangle) once for each of those whose cells the box shares.
  template <typename F>
  void forNear(const Bounds& box, const F& f) const {
    const Cells cells = cellsOf(box);
    forCells(cells, [&](std::size_t cell, int x, int y) {
      for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
        const Member& m = members_[i];
        const bool is_first = x == std::max(cells.first[0], m.x) && y == std::max(cells.first[1], m.y);
        if (is_first) f(*m.triangle);
      }
    });
  }

 private:
  struct Cells {
    int first[2], last[2];
  };
  struct Member {
    const ColumnTriangle* triangle;
    int x, y;  ///< its first cell
  };

  Cells cellsOf(const Bounds& box) const {
    const auto at = [&](int axis, double place) {
      return static_cast<int>(
          std::clamp((place - box_.min[axis]) * per_length_[axis], 0.0, count_[axis] - 1.0));
    };
    return {{at(0, box.min.x), at(1, box.min.y)}, {at(0, box.max.x), at(1, box.max.y)}};
  }

  template <typename F>
  void forCells(const Cells& cells, const F& f) const {
    for (int y = cells.first[1]; y <= cells.last[1]; ++y) {
      for (int x = cells.first[0]; x <= cells.last[0]; ++x)
        f(static_cast<std::size_t>(y) * count_[0] + x, x, y);
    }
  }

  Bounds box_;
  int count_[2];
  double per_length_[2];
  std::vector<std::uint32_t> first_;
  std::vector<Member> members_;
};

/// Sums over the columns of a box that holds all that is shared.
SharedSums sumColumns(const SurfaceView& a, const SurfaceView& b, const Bounds& box) {
  // What lies below the box in A, or above it in B, bounds nothing that is in the box.
  Bounds up = box, down = box;
  up.max.z = kEndless;
  down.min.z = -kEndless;
  const std::vector<ColumnTriangle> of_a = a.trianglesIn(up), of_b = b.trianglesIn(down);
  SharedSums sums;
  if (of_a.empty() || of_b.empty()) return sums;
  const ColumnGrid grid(of_b, box);
  for (const ColumnTriangle& t : of_a) {
    grid.forNear(t.box, [&](const ColumnTriangle& u) {
      if (isAbove(t.box, u.box)) addColumnPair(t, u, box, sums);
    });
  }
  return sums;
}

}  // namespace

SharedSums sharedVolume(const PlacedSurface& a, const PlacedSurface& b, const Vec3d& up) {
  const Mat3<double> frame = columnFrame(up), back = core::transposed(frame);
  const SurfaceView view_a(a, frame), view_b(b, frame);
  const Bounds box = sharedBox(view_a, view_b);
  if (isEmpty(box)) return {};
  SharedSums sums = sumColumns(view_a, view_b, box);
  if (!(sums.volume > kRounding * sums.magnitude)) return {};
  for (Vec3d* vector : {&sums.moment, &sums.area, &sums.turning}) *vector = back * *vector;
  return sums;
}

}  // namespace innersphere
