#include "surface/shared_volume.hpp"

#include <algorithm>
#include <cmath>

namespace innersphere {

namespace {

using core::Mat3;

/// Less than this, relative to the sum of absolute values, is what rounding leaves of no volume at all.
constexpr double kRounding = 1e-12;

/// Returns a frame whose z is near `up`. It leans by a few degrees in no special direction, so that the walls
/// of bodies that stand straight on each other are not seen from their edges.
Mat3<double> columnFrame(const Vec3d& up) {
  constexpr double kLean[] = {0.0713, 0.0457};
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

struct Box {
  Vec3d low, high;
};

/// This is a surface as seen in the frame of the columns.
class View {
 public:
  View(const PlacedSurface& surface, const Mat3<double>& frame)
      : tree_(surface.tree),
        matrix_(core::product(frame, surface.matrix)),
        translation_(frame * surface.translation) {
    std::transform(std::begin(matrix_.m), std::end(matrix_.m), std::begin(absolute_.m),
                   [](double x) { return std::abs(x); });
  }

  const SurfaceTree::Node& node(std::uint32_t index) const { return tree_.nodes()[index]; }

  Box box(std::uint32_t index) const {
    const Vec3d centre = matrix_ * node(index).centre + translation_, half = absolute_ * node(index).half;
    return {centre - half, centre + half};
  }

  struct Leaf {
    const ColumnTriangle* begin() const { return triangles; }
    const ColumnTriangle* end() const { return triangles + count; }
    ColumnTriangle triangles[SurfaceTree::kLeafTriangles];
    std::uint32_t count = 0;
  };

  /// Returns the triangles of a leaf, which stay until the next call.
  const Leaf& leaf(std::uint32_t index) {
    if (index == known_) return leaf_;
    known_ = index;
    leaf_.count = 0;
    for (std::uint32_t i = 0; i < node(index).count; ++i) {
      const SurfaceTree::Triangle& t = tree_.triangles()[node(index).first + i];
      const ColumnTriangle seen = makeColumnTriangle(place(t[0]), place(t[1]), place(t[2]));
      if (seen.side != 0) leaf_.triangles[leaf_.count++] = seen;
    }
    return leaf_;
  }

 private:
  Vec3d place(const Vec3f& p) const { return matrix_ * Vec3d{p.x, p.y, p.z} + translation_; }

  const SurfaceTree& tree_;
  Mat3<double> matrix_, absolute_;
  Vec3d translation_;
  std::uint32_t known_ = ~std::uint32_t{0};
  Leaf leaf_;
};

/// Returns whether a column of `a` may reach down to `b`.
template <typename A, typename B>
bool isAbove(const A& a, const B& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y &&
         b.low.z < a.high.z;
}

double width(const Box& box) {
  return box.high.x - box.low.x + box.high.y - box.low.y;
}

class Walk {
 public:
  Walk(const PlacedSurface& a, const PlacedSurface& b, const Mat3<double>& frame)
      : a_(a, frame), b_(b, frame) {}

  SharedSums run() {
    visit(0, a_.box(0), 0, b_.box(0));
    return sums_;
  }

 private:
  void visit(std::uint32_t i, const Box& box_a, std::uint32_t j, const Box& box_b) {
    if (!isAbove(box_a, box_b)) return;
    const bool leaf_a = a_.node(i).isLeaf(), leaf_b = b_.node(j).isLeaf();
    if (leaf_a && leaf_b) return addPairs(a_.leaf(i), b_.leaf(j));
    if (leaf_b || (!leaf_a && width(box_a) >= width(box_b))) {
      for (const std::uint32_t child : {i + 1, a_.node(i).first}) visit(child, a_.box(child), j, box_b);
    } else {
      for (const std::uint32_t child : {j + 1, b_.node(j).first}) visit(i, box_a, child, b_.box(child));
    }
  }

  void addPairs(const View::Leaf& a, const View::Leaf& b) {
    for (const ColumnTriangle& t : a) {
      for (const ColumnTriangle& u : b) {
        if (isAbove(t, u)) addColumnPair(t, u, sums_);
      }
    }
  }

  View a_, b_;
  SharedSums sums_;
};

}  // namespace

SharedSums sharedVolume(const PlacedSurface& a, const PlacedSurface& b, const Vec3d& up) {
  const Mat3<double> frame = columnFrame(up), back = core::transposed(frame);
  SharedSums sums = Walk(a, b, frame).run();
  if (!(sums.volume > kRounding * sums.magnitude)) return {};
  for (Vec3d* vector : {&sums.moment, &sums.area, &sums.turning}) *vector = back * *vector;
  return sums;
}

}  // namespace innersphere
