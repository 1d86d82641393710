#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

bool EdgedSolid::edgeTowards(std::size_t triangle, const btVector3& point, const btVector3& towards,
                             Edge& edge) const {
  SmoothNormals::SharpEdge found;
  if (!surface->sharpEdge(triangle, ((point - origin) * axes) / scale, towards * axes, found)) return false;
  edge.from = origin + axes * found.from * scale;
  edge.along = axes * (found.to - found.from) * scale;
  for (int i = 0; i < 2; ++i) edge.inwards[i] = axes * found.inwards[i];
  edge.id = found.id;
  return true;
}

bool EdgedSolid::nearestFace(const btVector3& place, btScalar reach, SurfaceTree::Nearest& nearest) const {
  return surface->nearest(((place - origin) * axes) / scale, reach / scale, nearest);
}

bool EdgedSolid::isIn(const btVector3& place, btScalar reach) const {
  SurfaceTree::Nearest nearest;
  return nearestFace(place, reach, nearest) && (nearest.distance < 0) != inside_out;
}

bool EdgedSolid::nearestTriangle(const btVector3& place, std::size_t& triangle) const {
  SurfaceTree::Nearest nearest;
  if (!nearestFace(place, BT_LARGE_FLOAT, nearest)) return false;
  triangle = nearest.triangle;
  return true;
}

bool EdgedSolid::distanceOf(const btVector3& place, btScalar& distance) const {
  SurfaceTree::Nearest nearest;
  if (!nearestFace(place, BT_LARGE_FLOAT, nearest)) return false;
  distance = btFabs(nearest.distance) * scale;
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
