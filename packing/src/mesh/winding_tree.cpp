#include "mesh/winding_tree.hpp"

#include <algorithm>
#include <numbers>

#include "common/bounds.hpp"

namespace innersphere {
namespace {

constexpr std::uint32_t kLeaf = 4;
// A dipole is used from this many radii of its triangles on.
constexpr double kFar = 2;

/// Sums angles of the plane, given as vectors, with one arc tangent for all: multiplies them as complex
/// numbers, and counts how often the product goes round.
class AngleSum {
 public:
  void add(double x, double y) {
    if (x == 0 && y == 0) return;
    const double re = re_ * x - im_ * y;
    const double im = re_ * y + im_ * x + 0.0;  // never -0, whose angle is -pi instead of pi
    if (im_ >= 0 && y >= 0 && im < 0) ++turns_;
    if (im_ < 0 && y < 0 && im >= 0) --turns_;
    re_ = re;
    im_ = im;
    const double size = std::max(std::abs(re), std::abs(im));
    if (size < 1e-100 || size > 1e100) {
      re_ /= size;
      im_ /= size;
    }
  }
  double turns() const { return turns_ + std::atan2(im_, re_) / (2 * std::numbers::pi); }

 private:
  double re_ = 1, im_ = 0;
  int turns_ = 0;
};

// Half of the solid angle, by Van Oosterom and Strackee 1983.
void addTriangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c, AngleSum& sum) {
  const Vec3d pa = a - p, pb = b - p, pc = c - p;
  const double la = norm(pa), lb = norm(pb), lc = norm(pc);
  const double volume = dot(pa, cross(pb, pc));
  sum.add(la * lb * lc + dot(pa, pb) * lc + dot(pb, pc) * la + dot(pc, pa) * lb, volume);
}

}  // namespace

double windingNumber(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  AngleSum sum;
  addTriangle(p, a, b, c, sum);
  return sum.turns();
}

WindingTree::WindingTree(const Mesh& mesh) {
  triangles_.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    triangles_.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  }
  nodes_.reserve(triangles_.size());
  build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void WindingTree::build(std::uint32_t begin, std::uint32_t end) {
  const auto middle = [](const Corners& t) { return (1.0 / 3) * (t.a + t.b + t.c); };
  Node node;
  node.begin = begin;
  node.end = end;
  Bounds middles = emptyBounds();
  Vec3d moment{};
  double total = 0;
  const Vec3d origin = triangles_[begin].a;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Corners& t = triangles_[i];
    const Vec3d area = 0.5 * cross(t.b - t.a, t.c - t.a);
    const double size = norm(area);
    node.area = node.area + area;
    moment = moment + size * (middle(t) - origin);
    total += size;
    extend(middles, middle(t));
  }
  node.centre = total > 0 ? origin + (1 / total) * moment : origin;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const Vec3d& corner : {triangles_[i].a, triangles_[i].b, triangles_[i].c}) {
      const Vec3d away = corner - node.centre;
      node.far2 = std::max(node.far2, kFar * kFar * dot(away, away));
    }
  }

  const std::size_t self = nodes_.size();
  nodes_.push_back(node);
  if (end - begin > kLeaf) {
    const Vec3d size = middles.max - middles.min;
    const int axis = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(triangles_.begin() + begin, triangles_.begin() + half, triangles_.begin() + end,
                     [&](const Corners& s, const Corners& t) { return middle(s)[axis] < middle(t)[axis]; });
    build(begin, half);
    build(half, end);
  }
  nodes_[self].skip = static_cast<std::uint32_t>(nodes_.size());
}

double WindingTree::windingNumber(const Vec3d& p) const {
  double sum = 0;
  AngleSum near;
  for (std::uint32_t n = 0; n < nodes_.size();) {
    const Node& node = nodes_[n];
    const Vec3d away = node.centre - p;
    const double d2 = dot(away, away);
    if (d2 > node.far2) {
      sum += dot(node.area, away) / (4 * std::numbers::pi * d2 * std::sqrt(d2));
      n = node.skip;
    } else if (node.end - node.begin <= kLeaf) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const Corners& t = triangles_[i];
        addTriangle(p, t.a, t.b, t.c, near);
      }
      n = node.skip;
    } else {
      ++n;
    }
  }
  return sum + near.turns();
}

}  // namespace innersphere
