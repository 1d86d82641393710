#include "nearest_triangle.hpp"

#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include "vec.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Triangles whose nearest points differ by less than this fraction of the distance share them.
constexpr btScalar kSame = btScalar(1e-5);

btScalar distance2(const btDbvtVolume& box, const btVector3& point) {
  btVector3 outside = box.Mins() - point;
  outside.setMax(point - box.Maxs());
  outside.setMax(btVector3(0, 0, 0));
  return outside.length2();
}

class Search {
 public:
  Search(const Surface& surface, const btVector3& point, btScalar reach)
      : surface_(surface), point_(point), best2_(reach * reach) {}

  void descend(const btDbvtNode* node) {
    if (node->isleaf()) {
      test(static_cast<std::size_t>(node->dataAsInt));
      return;
    }
    const btDbvtNode* child[2] = {node->childs[0], node->childs[1]};
    btScalar far2[2] = {distance2(child[0]->volume, point_), distance2(child[1]->volume, point_)};
    const int first = far2[1] < far2[0] ? 1 : 0;
    for (int k : {first, 1 - first}) {
      if (far2[k] <= best2_ * (1 + kSame)) descend(child[k]);
    }
  }

  bool result(NearestTriangle::Result& result) const {
    if (!found_) return false;
    const btScalar distance = btSqrt(best2_);
    const bool inside = height_ < 0;
    result.distance = inside ? -distance : distance;
    result.normal = distance > SIMD_EPSILON ? offset_ / (inside ? -distance : distance) : face_;
    return true;
  }

 private:
  void test(std::size_t t) {
    btVector3 v[3];
    for (int k = 0; k < 3; ++k) v[k] = toBullet(surface_.vertices[surface_.triangles[t][k]]);
    const btVector3 normal = (v[1] - v[0]).cross(v[2] - v[0]);
    if (!(normal.length2() > 0)) return;
    btSubSimplexClosestResult closest;
    closest.reset();
    solver_.closestPtPointTriangle(point_, v[0], v[1], v[2], closest);
    const btVector3 offset = point_ - closest.m_closestPointOnSimplex;
    const btScalar length2 = offset.length2();
    if (length2 > best2_ * (1 + kSame)) return;
    // Of those that share the nearest point, the one seen from the steepest angle tells inside from outside.
    const btVector3 face = normal.normalized();
    const btScalar height = offset.dot(face);
    const bool shared = found_ && length2 >= best2_ * (1 - kSame);
    if (!shared || btFabs(height) > btFabs(height_)) {
      height_ = height;
      face_ = face;
    }
    if (length2 < best2_ || !found_) {
      best2_ = length2;
      offset_ = offset;
    }
    found_ = true;
  }

  const Surface& surface_;
  const btVector3 point_;
  btScalar best2_;
  bool found_ = false;
  btScalar height_ = 0;
  btVector3 face_{0, 0, 0};
  btVector3 offset_{0, 0, 0};
  btVoronoiSimplexSolver solver_;
};

}  // namespace

NearestTriangle::NearestTriangle(const Surface& surface) : surface_(surface) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    btVector3 corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = toBullet(surface.vertices[surface.triangles[t][k]]);
    tree_.insert(btDbvtVolume::FromPoints(corners, 3), nullptr)->dataAsInt = static_cast<int>(t);
  }
  tree_.optimizeTopDown();
}

bool NearestTriangle::find(const btVector3& point, btScalar reach, Result& result) const {
  if (tree_.m_root == nullptr) return false;
  Search search(surface_, point, reach);
  search.descend(tree_.m_root);
  return search.result(result);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
