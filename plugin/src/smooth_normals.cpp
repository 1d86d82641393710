#include "smooth_normals.hpp"

#include <algorithm>

#include "vec.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr btScalar kSmooth = btScalar(0.866);  // cos 30 degrees
/// Normals that differ by less are those of a flat face, but for rounding [rad].
constexpr btScalar kFlat = btScalar(1e-4);
/// Instead of the triangle across a sharp edge, or one that no other triangle shares.
constexpr std::uint32_t kSharp = ~std::uint32_t(0), kSeam = kSharp - 1;
/// Triangles that are crossed to look for one, for the bulge of a triangle and for where a face ends.
constexpr int kCrossed = 4;
constexpr int kCrossedFar = 12;

/// Twice the area of a triangle along its normal.
btVector3 areaVector(const Surface& surface, std::size_t t) {
  const auto& triangle = surface.triangles[t];
  const btVector3 a = toBullet(surface.vertices[triangle[0]]);
  return (toBullet(surface.vertices[triangle[1]]) - a).cross(toBullet(surface.vertices[triangle[2]]) - a);
}

btVector3 unit(const btVector3& v) {
  const btScalar length = v.length();
  return length > 0 ? v / length : btVector3(0, 0, 0);
}

}  // namespace

SmoothNormals::SmoothNormals(const Surface& surface)
    : surface_(surface),
      corners_(3 * surface.triangles.size()),
      across_(3 * surface.triangles.size(), kSeam) {
  std::vector<std::vector<std::uint32_t>> around(surface.vertices.size());
  std::vector<btVector3> faces(surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    faces[t] = unit(areaVector(surface, t));
    for (std::uint32_t v : surface.triangles[t]) around[v].push_back(static_cast<std::uint32_t>(t));
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = surface.triangles[t][k];
      btVector3 sum(0, 0, 0);
      for (std::uint32_t other : around[v]) {
        const auto& triangle = surface.triangles[other];
        const std::uint32_t next = surface.triangles[t][(k + 1) % 3];
        const bool smooth = !(faces[t].dot(faces[other]) < kSmooth);
        if (other != t && std::find(triangle.begin(), triangle.end(), next) != triangle.end())
          across_[3 * t + k] = smooth ? other : kSharp;
        if (!smooth) continue;
        // Weighted by the angle at the corner, so that it does not matter how faces are cut.
        const int at = triangle[0] == v ? 0 : triangle[1] == v ? 1 : 2;
        const btVector3 p = toBullet(surface.vertices[v]);
        const btVector3 e1 = unit(toBullet(surface.vertices[triangle[(at + 1) % 3]]) - p);
        const btVector3 e2 = unit(toBullet(surface.vertices[triangle[(at + 2) % 3]]) - p);
        sum += faces[other] * btAcos(btClamped(e1.dot(e2), btScalar(-1), btScalar(1)));
      }
      corners_[3 * t + k] = toFloats(unit(sum));
    }
  }
}

SmoothNormals::Place SmoothNormals::at(std::size_t t, const btVector3& point) const {
  const auto& triangle = surface_.triangles[t];
  btVector3 v[3], n[3];
  for (int k = 0; k < 3; ++k) {
    v[k] = toBullet(surface_.vertices[triangle[k]]);
    n[k] = toBullet(corners_[3 * t + k]);
  }
  const btVector3 normal = (v[1] - v[0]).cross(v[2] - v[0]);
  btScalar weight[3];
  btVector3 sum(0, 0, 0);
  for (int k = 0; k < 3; ++k) {
    weight[k] = (v[(k + 1) % 3] - point).cross(v[(k + 2) % 3] - point).dot(normal) / normal.length2();
    sum += n[k] * weight[k];
  }
  // The parabola with these normals along each edge; on a ball that is its height over the triangle, to
  // second order.
  btScalar bulge = 0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    bulge += weight[k] * weight[next] * (n[next] - n[k]).dot(v[next] - v[k]) / 2;
  }
  return {unit(sum), bulge};
}

bool SmoothNormals::isPastSharpEdge(std::size_t t, const btVector3& point) const {
  for (int i = 0; i < kCrossed; ++i) {
    btVector3 v[3];
    for (int k = 0; k < 3; ++k) v[k] = toBullet(surface_.vertices[surface_.triangles[t][k]]);
    const btVector3 normal = (v[1] - v[0]).cross(v[2] - v[0]);
    std::size_t edge = 3;
    for (std::size_t k = 0; k < 3 && edge == 3; ++k) {
      if ((v[(k + 1) % 3] - v[k]).cross(point - v[k]).dot(normal) < 0) edge = k;
    }
    if (edge == 3) return false;
    t = across_[3 * t + edge];
    if (t == kSharp || t == kSeam) return t == kSharp;
  }
  return false;
}

btScalar SmoothNormals::untilSharpEdge(std::size_t t, const btVector3& point, const btVector3& towards,
                                       btScalar farthest) const {
  btVector3 at = point;
  btScalar way = 0;
  for (int i = 0; i < kCrossedFar && way < farthest; ++i) {
    btVector3 v[3];
    for (int k = 0; k < 3; ++k) v[k] = toBullet(surface_.vertices[surface_.triangles[t][k]]);
    const btVector3 normal = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
    const btVector3 along = towards - normal * towards.dot(normal);
    // The edge by which the line along the triangle leaves it.
    std::size_t edge = 3;
    btScalar nearest = BT_LARGE_FLOAT;
    for (std::size_t k = 0; k < 3; ++k) {
      const btVector3 inwards = normal.cross(v[(k + 1) % 3] - v[k]);
      const btScalar speed = -along.dot(inwards);
      if (!(speed > 0)) continue;
      const btScalar time = btMax(btScalar(0), (at - v[k]).dot(inwards) / speed);
      if (time < nearest) {
        nearest = time;
        edge = k;
      }
    }
    if (edge == 3) return farthest;
    way += nearest * along.length();
    at += along * nearest;
    t = across_[3 * t + edge];
    if (t == kSharp) return btMin(way, farthest);
    if (t == kSeam) break;
  }
  return farthest;
}

btScalar SmoothNormals::curvature(std::size_t t) const {
  const auto& triangle = surface_.triangles[t];
  btScalar most = 0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const btVector3 turn = toBullet(corners_[3 * t + next]) - toBullet(corners_[3 * t + k]);
    const btVector3 edge =
        toBullet(surface_.vertices[triangle[next]]) - toBullet(surface_.vertices[triangle[k]]);
    if (turn.length() < kFlat || !(edge.length2() > 0)) continue;
    const btScalar along = turn.dot(edge) / edge.length2();
    if (btFabs(along) > btFabs(most)) most = along;
  }
  return most;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
