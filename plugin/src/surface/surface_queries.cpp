#include "surface/surface_queries.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <BulletCollision/CollisionShapes/btTriangleCallback.h>

#include "common/bullet_vectors.hpp"
#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

using Lanes = TriangleBvh::Lanes;
/// Ratio: hits whose distances differ by less lie on an edge that both triangles share.
constexpr btScalar kShared = btScalar(1e-5);
/// Cosine, 84 degrees: rays that are flatter to a triangle meet it itself, not the curved surface that it
/// stands for.
constexpr btScalar kGrazing = btScalar(0.1);
/// Cosine, 15 degrees: a nearest point that is seen from further aside lies on an edge.
constexpr btScalar kOver = btScalar(0.966);
/// In the thickness asked for: a ray starts so far below the surface, so as not to meet it there.
constexpr btScalar kBelow = btScalar(1e-3);
/// Distance of unit vectors: a smoothed normal that is closer to its triangle's is drawn for it.
constexpr btScalar kUpright = btScalar(0.01);
/// In the thickness asked for: what lies within this much beside a triangle may be met by such lines, too.
constexpr btScalar kAround = btScalar(0.1);

/// The same vector in every lane.
struct VectorLanes {
  explicit VectorLanes(const btVector3& v) {
    for (int k = 0; k < 3; ++k) all[k] = Lanes{} + static_cast<float>(v[k]);
  }
  Lanes all[3];
};

/// How far along a ray its parts inside of boxes begin, and at least where it meets triangles.
class EntersAt {
 public:
  /// `rounding`: of heights over planes [m].
  EntersAt(const btVector3& from, const btVector3& direction, float rounding)
      : start_(from), way_(direction), rounding_(rounding) {
    for (int k = 0; k < 3; ++k) {
      from_[k] = static_cast<float>(from[k]);
      // Large, but finite: times nothing it is nothing.
      inverse_[k] =
          static_cast<float>(1 / std::copysign(btMax(btFabs(direction[k]), btScalar(1e-20)), direction[k]));
    }
  }
  Lanes operator()(const TriangleBvh::Boxes& boxes) const {
    Lanes enter{}, leave = enter + kFar;
    for (int k = 0; k < 3; ++k) {
      const Lanes a = (boxes.min[k] - from_[k]) * inverse_[k], b = (boxes.max[k] - from_[k]) * inverse_[k];
      enter = larger(enter, lesser(a, b));
      leave = lesser(leave, larger(a, b));
    }
    return enter <= leave ? enter : Lanes{} + kFar;
  }
  Lanes operator()(const TriangleBvh::Leaf& leaf) const;

 private:
  VectorLanes start_, way_;
  float rounding_;
  std::array<float, 3> from_, inverse_;
};

Lanes EntersAt::operator()(const TriangleBvh::Leaf& leaf) const {
  const Lanes* const n = leaf.faces.normal;
  const Lanes along = n[0] * way_.all[0] + n[1] * way_.all[1] + n[2] * way_.all[2];
  const Lanes distance = -leaf.faces.heightsOf(start_.all) / along;
  // The flatter the line, the less is known of where it passes the plane.
  const Lanes error = rounding_ + rounding_ / larger(along, -along);
  Lanes at[3];
  for (int k = 0; k < 3; ++k) at[k] = start_.all[k] + way_.all[k] * distance;
  Lanes height = leaf.edges[0].heightsOf(at);
  for (int k = 1; k < 3; ++k) height = lesser(height, leaf.edges[k].heightsOf(at));
  // Not a number, of a line along a plane, is no miss.
  const auto misses = (height + error < leaf.lowest) | (distance + error < 0);
  const Lanes least = distance - error;
  return misses ? Lanes{} + kFar : (least > 0 ? least : Lanes{});
}

/// Whether boxes and triangles are surely apart from a box.
class Apart {
 public:
  /// `rounding`: of heights over planes [m].
  Apart(const btVector3& min, const btVector3& max, float rounding)
      : min_(min), max_(max), middle_((min + max) / 2), half_((max - min) / 2), rounding_(rounding) {}
  Lanes operator()(const TriangleBvh::Boxes& boxes) const {
    Lanes distances{};
    for (std::size_t lane = 0; lane < TriangleBvh::kWidth; ++lane) {
      for (int k = 0; k < 3; ++k) {
        if (boxes.max[k][lane] < min_[k] || boxes.min[k][lane] > max_[k]) distances[lane] = kFar;
      }
    }
    return distances;
  }
  Lanes operator()(const TriangleBvh::Leaf& leaf) const {
    Lanes gap = beside(leaf.faces, -1);
    for (const TriangleBvh::Planes& edges : leaf.edges) gap = larger(gap, beside(edges, -1));
    gap = larger(gap, beside(leaf.faces, 1));
    return gap > 0 ? Lanes{} + kFar : Lanes{};
  }

 private:
  /// How far all of the box is in front of planes, or, on the side -1, behind them.
  Lanes beside(const TriangleBvh::Planes& planes, float side) const {
    Lanes reach = Lanes{} + rounding_;
    for (int k = 0; k < 3; ++k) reach += larger(planes.normal[k], -planes.normal[k]) * half_.all[k];
    return side * planes.heightsOf(middle_.all) - reach;
  }

  const btVector3 min_, max_;
  const VectorLanes middle_, half_;
  const float rounding_;
};

/// What the curved surface is like where its triangle is hit.
void complete(const SmoothNormals& normals, const SmoothNormals::Crossing& crossing, const btVector3& from,
              const btVector3& direction, SurfaceQueries::Hit& hit) {
  hit.distance = crossing.distance;
  hit.face = normals.face(hit.triangle);
  hit.curvature = normals.curvature(hit.triangle);
  const SmoothNormals::Place place = normals.at(hit.triangle, crossing);
  hit.normal = place.normal;
  const btScalar facing = hit.face.dot(direction);
  if (!(btFabs(facing) > kGrazing)) return;
  // Past an edge it is another face that ends the solid, and sooner.
  const btScalar further = hit.distance + place.bulge / facing;
  if (place.bulge > 0 && normals.isPastSharpEdge(hit.triangle, from + direction * further)) return;
  hit.distance = further;
}

/// The nearest point of a triangle, by its Voronoi regions: Ericson, "Real-Time Collision Detection" (2005),
/// 5.1.5.
btVector3 nearestOfTriangle(const btVector3* corners, const btVector3& point) {
  const btVector3 &a = corners[0], &b = corners[1], &c = corners[2];
  const btVector3 ab = b - a, ac = c - a, from_a = point - a;
  const btScalar ab_a = ab.dot(from_a), ac_a = ac.dot(from_a);
  if (ab_a <= 0 && ac_a <= 0) return a;
  const btVector3 from_b = point - b;
  const btScalar ab_b = ab.dot(from_b), ac_b = ac.dot(from_b);
  if (ab_b >= 0 && ac_b <= ab_b) return b;
  const btScalar beyond_ab = ab_a * ac_b - ab_b * ac_a;
  if (beyond_ab <= 0 && ab_a >= 0 && ab_b <= 0) return a + ab_a / (ab_a - ab_b) * ab;
  const btVector3 from_c = point - c;
  const btScalar ab_c = ab.dot(from_c), ac_c = ac.dot(from_c);
  if (ac_c >= 0 && ab_c <= ac_c) return c;
  const btScalar beyond_ac = ab_c * ac_a - ab_a * ac_c;
  if (beyond_ac <= 0 && ac_a >= 0 && ac_c <= 0) return a + ac_a / (ac_a - ac_c) * ac;
  const btScalar beyond_bc = ab_b * ac_c - ab_c * ac_b, bc_b = ac_b - ab_b, cb_c = ab_c - ac_c;
  if (beyond_bc <= 0 && bc_b >= 0 && cb_c >= 0) return b + bc_b / (bc_b + cb_c) * (c - b);
  const btScalar share = 1 / (beyond_bc + beyond_ac + beyond_ab);
  return a + ab * (beyond_ac * share) + ac * (beyond_ab * share);
}

/// The nearest of the triangles that it is shown to a point.
class NearestTriangle {
 public:
  /// Triangles further away from `point` than `max_distance` do not count. `rounding`: of heights over planes
  /// [m].
  NearestTriangle(const SmoothNormals& triangles, const btVector3& point, btScalar max_distance,
                  float rounding)
      : triangles_(triangles),
        point_(point),
        lanes_(point),
        rounding_(rounding),
        best2_(max_distance * max_distance) {}

  /// Squares of distances from the point, at least: of boxes, of triangles, and that beyond which nothing is
  /// looked for.
  Lanes operator()(const TriangleBvh::Boxes& boxes) const;
  Lanes operator()(const TriangleBvh::Leaf& leaf) const;
  btScalar farthest2() const { return best2_ * (1 + kSame); }
  /// Shows it a triangle; farthest2() thereafter.
  btScalar test(std::size_t triangle);

  bool found() const { return found_; }
  /// Only if found(): of the point from the surface [m], negative inside the solid.
  btScalar distance() const;
  /// Unit, out of the solid, along the line from the nearest point.
  btVector3 normal() const;
  /// Of those that share the nearest point, the one seen from the steepest angle.
  std::size_t triangle() const { return triangle_; }
  /// It is seen from 15 degrees or more.
  bool beside() const;

 private:
  /// Triangles whose nearest points differ by less than this fraction of the distance share them.
  static constexpr btScalar kSame = btScalar(1e-5);

  const SmoothNormals& triangles_;
  const btVector3 point_;
  const VectorLanes lanes_;
  const float rounding_;
  btScalar best2_;
  bool found_ = false;
  btScalar height_ = 0;
  btVector3 face_{0, 0, 0};
  std::size_t triangle_ = 0;
  btVector3 offset_{0, 0, 0};
};

Lanes NearestTriangle::operator()(const TriangleBvh::Boxes& boxes) const {
  Lanes sum{};
  for (int k = 0; k < 3; ++k) {
    const Lanes at = lanes_.all[k];
    const Lanes outside = larger(boxes.min[k] - at, at - boxes.max[k]);
    const Lanes gap = larger(outside, Lanes{});
    sum += gap * gap;
  }
  return sum;
}

Lanes NearestTriangle::operator()(const TriangleBvh::Leaf& leaf) const {
  const Lanes height = leaf.faces.heightsOf(lanes_.all);
  const Lanes over = larger(larger(height, -height) - rounding_, Lanes{});
  Lanes beyond{};
  for (const TriangleBvh::Planes& edges : leaf.edges)
    beyond = larger(beyond, -edges.heightsOf(lanes_.all) - rounding_);
  return over * over + beyond * beyond;
}

btScalar NearestTriangle::test(std::size_t t) {
  const btVector3& face = triangles_.face(t);
  if (face.isZero()) return farthest2();
  const btVector3 offset = point_ - nearestOfTriangle(triangles_.corners(t), point_);
  const btScalar length2 = offset.length2();
  if (length2 > farthest2()) return farthest2();
  // Of those that share the nearest point, the one seen from the steepest angle tells inside from outside.
  const btScalar height = offset.dot(face);
  const bool shared = found_ && length2 >= best2_ * (1 - kSame);
  const bool steeper =
      btFabs(height) > btFabs(height_) || (btFabs(height) == btFabs(height_) && t < triangle_);
  if (!shared || steeper) {
    height_ = height;
    face_ = face;
    triangle_ = t;
  }
  if (length2 < best2_ || !found_) {
    best2_ = length2;
    offset_ = offset;
  }
  found_ = true;
  return farthest2();
}

btScalar NearestTriangle::distance() const {
  return height_ < 0 ? -btSqrt(best2_) : btSqrt(best2_);
}

btVector3 NearestTriangle::normal() const {
  return btSqrt(best2_) > btScalar(rounding_) ? offset_ / distance() : face_;
}

bool NearestTriangle::beside() const {
  return btFabs(height_) < kOver * btSqrt(best2_);
}

}  // namespace

btScalar diagonalOf(const Surface& surface) {
  btVector3 min = toBullet(surface.vertices[0]), max = min;
  for (const auto& vertex : surface.vertices) {
    min.setMin(toBullet(vertex));
    max.setMax(toBullet(vertex));
  }
  return (max - min).length();
}

SurfaceQueries::SurfaceQueries(const Surface& surface)
    : surface_(surface), tree_(surface), open_below_(surface.triangles.size()) {}

void SurfaceQueries::processTriangles(btTriangleCallback* callback, const btVector3& min,
                                      const btVector3& max) const {
  tree_.search(0, Apart(min, max, tree_.rounding()), [&](std::uint32_t t) {
    btVector3 corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = toBullet(surface_.vertices[surface_.triangles[t][k]]);
    callback->processTriangle(corners, 0, static_cast<int>(t));
    return btScalar(0);
  });
}

bool SurfaceQueries::cast(const btVector3& from, const btVector3& direction, btScalar length,
                          const btVector3& towards, Hit& hit) const {
  const SmoothNormals& normals = this->normals();
  SmoothNormals::Crossing nearest;
  nearest.distance = length;
  bool found = false;
  tree_.search(length, EntersAt(from, direction, tree_.rounding()), [&](std::uint32_t t) {
    SmoothNormals::Crossing crossing;
    if (!normals.cross(t, from, direction, crossing) || !(crossing.distance > 0))
      return nearest.distance * (1 + kShared);
    const bool shared = found && btFabs(crossing.distance - nearest.distance) < kShared * nearest.distance;
    if (shared ? normals.face(t).dot(towards) > normals.face(hit.triangle).dot(towards)
               : crossing.distance < nearest.distance) {
      nearest = crossing;
      hit.triangle = t;
      found = true;
    }
    return nearest.distance * (1 + kShared);
  });
  if (found) complete(normals, nearest, from, direction, hit);
  return found;
}

bool SurfaceQueries::castNear(std::size_t triangle, const btVector3& from, const btVector3& direction,
                              btScalar length, Hit& hit) const {
  const SmoothNormals& normals = this->normals();
  SmoothNormals::Crossing crossing;
  if (!normals.crossNear(triangle, from, direction, crossing) || !(btFabs(crossing.distance) < length))
    return false;
  hit.triangle = triangle;
  complete(normals, crossing, from, direction, hit);
  return true;
}

bool SurfaceQueries::isThinner(btScalar thickness, const btVector3& place, const btVector3& normal) const {
  Hit hit;
  return cast(place - normal * (kBelow * thickness), -normal, thickness, -normal, hit) &&
         hit.face.dot(normal) < -kOpposedCosine;
}

bool SurfaceQueries::isThinner(btScalar thickness, std::size_t triangle, const btVector3& place,
                               const btVector3& normal) const {
  const bool upright = normal.distance2(normals().face(triangle)) < kUpright * kUpright;
  return (!upright || isOpposedBelow(thickness, triangle)) && isThinner(thickness, place, normal);
}

/// Whether a triangle that looks the other way may be met by a line drawn inwards from this one.
bool SurfaceQueries::isOpposedBelow(btScalar thickness, std::size_t triangle) const {
  std::atomic<btScalar>& open = open_below_[triangle];
  const btScalar known = open.load(std::memory_order_relaxed);
  if (known < 0 || known >= thickness) return known < 0;
  const btVector3& face = normals().face(triangle);
  const btVector3* const corners = normals().corners(triangle);
  btVector3 min = corners[0], max = corners[0];
  for (int k = 0; k < 3; ++k) {
    for (const btVector3& at : {corners[k], corners[k] - face * thickness}) {
      min.setMin(at);
      max.setMax(at);
    }
  }
  const btScalar around = kAround * thickness;
  const btVector3 beside(around, around, around);
  bool opposed = false;
  tree_.search(0, Apart(min - beside, max + beside, tree_.rounding()), [&](std::uint32_t t) {
    opposed = opposed || normals().face(t).dot(face) < -kOpposedCosine + kUpright;
    return btScalar(opposed ? -1 : 0);
  });
  open.store(opposed ? btScalar(-1) : thickness, std::memory_order_relaxed);
  return opposed;
}

bool SurfaceQueries::nearest(const btVector3& point, btScalar max_distance, Nearest& result) const {
  NearestTriangle search(normals(), point, max_distance, tree_.rounding());
  tree_.search(search.farthest2(), search, [&](std::uint32_t t) { return search.test(t); });
  if (!search.found()) return false;
  result = {search.distance(), search.normal(), search.triangle(), search.beside()};
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
