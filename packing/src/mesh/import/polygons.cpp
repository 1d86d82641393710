#include "mesh/import/polygons.hpp"

#include <cmath>
#include <limits>
#include <span>

#include "innersphere/error.hpp"
#include "mesh/mesh_report.hpp"

namespace innersphere {
namespace {

using Point = std::array<double, 2>;

// Twice the signed area of a triangle.
double area(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Cuts polygons into triangles by their ears (G. H. Meisters, Polygons have ears, 1975), every other one on
// the way around, so that round faces do not become needles.
class Triangulator {
 public:
  explicit Triangulator(const std::vector<Vec3d>& vertices) : vertices_(vertices) {}

  // False if that would take too long.
  bool add(std::span<const std::uint32_t> corners, std::vector<std::array<std::uint32_t, 3>>& triangles);

 private:
  void project(std::span<const std::uint32_t> corners);
  bool isEar(std::uint32_t ear);
  bool covers(std::uint32_t ear, const Point& p) const;

  // So many looks at a corner take about a second; files of real polygons need a thousandth of it.
  static constexpr std::size_t kMostLooks = 100'000'000;

  const std::vector<Vec3d>& vertices_;
  std::size_t looks_ = 0;
  std::vector<Point> points_;  // of the polygon, in its plane, counter-clockwise
  std::vector<std::uint32_t> previous_, next_;
  std::vector<std::uint32_t> reflex_;  // corners that were not convex at first: only they lie in other ears
  std::vector<bool> gone_;
};

// Leaves out the axis that the polygon faces most.
void Triangulator::project(std::span<const std::uint32_t> corners) {
  const std::size_t n = corners.size();
  const Vec3d origin = vertices_[corners[0]];
  Vec3d normal{};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    normal = normal + cross(vertices_[corners[i]] - origin, vertices_[corners[i + 1]] - origin);
  }
  int out = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[out])) out = k;
  }
  int first = (out + 1) % 3, second = (out + 2) % 3;
  if (normal[out] < 0) std::swap(first, second);
  points_.clear();
  for (std::uint32_t v : corners) {
    const Vec3d p = vertices_[v] - origin;
    points_.push_back({p[first], p[second]});
  }
}

bool Triangulator::covers(std::uint32_t ear, const Point& p) const {
  const Point &a = points_[previous_[ear]], &b = points_[ear], &c = points_[next_[ear]];
  if (p == a || p == b || p == c) return false;
  return area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
}

bool Triangulator::isEar(std::uint32_t ear) {
  if (!(area(points_[previous_[ear]], points_[ear], points_[next_[ear]]) > 0)) return false;
  looks_ += reflex_.size();
  for (std::uint32_t i : reflex_) {
    if (!gone_[i] && covers(ear, points_[i])) return false;
  }
  return true;
}

bool Triangulator::add(std::span<const std::uint32_t> corners,
                       std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const auto n = static_cast<std::uint32_t>(corners.size());
  if (n == 0) return true;
  if (n <= 3) {
    triangles.push_back({corners[0], corners[n > 1 ? 1 : 0], corners[n - 1]});
    return true;
  }
  project(corners);
  previous_.resize(n);
  next_.resize(n);
  gone_.assign(n, false);
  reflex_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    previous_[i] = (i + n - 1) % n;
    next_[i] = (i + 1) % n;
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    if (!(area(points_[previous_[i]], points_[i], points_[next_[i]]) > 0)) reflex_.push_back(i);
  }
  std::uint32_t left = n, at = 1, misses = 0;
  while (left > 3 && misses < left) {
    if (!isEar(at)) {
      at = next_[at];
      ++misses;
      if (looks_ > kMostLooks) return false;
      continue;
    }
    triangles.push_back({corners[previous_[at]], corners[at], corners[next_[at]]});
    gone_[at] = true;
    next_[previous_[at]] = next_[at];
    previous_[next_[at]] = previous_[at];
    at = next_[next_[at]];
    --left;
    misses = 0;
  }
  std::uint32_t root = 0;
  while (gone_[root]) ++root;
  for (std::uint32_t i = next_[root]; next_[i] != root; i = next_[i]) {
    triangles.push_back({corners[root], corners[i], corners[next_[i]]});
  }
  return true;
}

}  // namespace

std::string Polygons::faultOf(const Vec3d& p) const {
  constexpr double kLargest = std::numeric_limits<float>::max();
  if (std::abs(p[0]) <= kLargest && std::abs(p[1]) <= kLargest && std::abs(p[2]) <= kLargest) return {};
  return "vertex " + std::to_string(vertices.size()) + " is " + text(p) +
         "; remove it or export the mesh again";
}

void Polygons::endFace(std::size_t place) {
  faces_.push_back({corners_.size(), place});
}

Mesh Polygons::triangulate(const std::string& path, const char* unit) && {
  Mesh mesh;
  Triangulator triangulator(vertices);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const std::span<const std::uint32_t> corners(corners_.data() + begin, faces_[i].end - begin);
    begin = faces_[i].end;
    const auto fail = [&](const std::string& what) {
      throw Error(ErrorCode::bad_format, path + ", " + unit + " " + std::to_string(faces_[i].place) +
                                             ": face " + std::to_string(i) + what);
    };
    for (std::uint32_t v : corners) {
      if (v >= vertices.size()) {
        fail(" uses vertex " + std::to_string(v) + " of " + std::to_string(vertices.size()) +
             " (counted from 0); export the mesh again");
      }
    }
    if (!triangulator.add(corners, mesh.triangles)) {
      fail(" has " + std::to_string(corners.size()) +
           " corners and too many dents to be cut into triangles; export triangles");
    }
  }
  mesh.vertices = std::move(vertices);
  return mesh;
}

}  // namespace innersphere
