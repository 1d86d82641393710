#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

bool SharpEdges::edgeTowards(std::size_t triangle, const btVector3& point, const btVector3& towards,
                             Edge& edge) const {
  const SmoothNormals& normals = surface->normals();
  edge.where = normals.untilSharpEdge(triangle, ((point - origin) * axes) / scale, towards * axes);
  if (!edge.where.found()) return false;
  place(edge);
  return true;
}

btScalar SharpEdges::untilEdge(std::size_t triangle, const btVector3& point, const btVector3& towards) const {
  Edge edge;
  if (!edgeTowards(triangle, point, towards, edge) || isValley(edge)) return BT_LARGE_FLOAT;
  return edge.where.distance * scale;
}

void SharpEdges::place(Edge& edge) const {
  const SmoothNormals::Ends ends = surface->normals().endsOf(edge.where);
  edge.from = origin + axes * ends.from * scale;
  edge.along = axes * (ends.to - ends.from) * scale;
}

bool SharpEdges::walk(std::size_t triangle, const btVector3& point, const btVector3& way, btScalar most,
                      SmoothNormals::Walked& walked) const {
  return surface->normals().walk(triangle, ((point - origin) * axes) / scale, (way * axes) / scale, most,
                                 walked);
}

SharpEdges::Edge SharpEdges::edgeOf(const SmoothNormals::Walked& walked) const {
  Edge edge;
  edge.where = {0, walked.triangle, walked.edge};
  place(edge);
  return edge;
}

SharpEdges::Faces SharpEdges::facesOf(const Edge& edge) const {
  const SmoothNormals::EdgeFaces found = surface->normals().facesOf(edge.where);
  return {{axes * found.inwards[0], axes * found.inwards[1]}, found.id, found.across};
}

bool SharpEdges::isValley(const Edge& edge) const {
  return surface->normals().isValley(edge.where) != inside_out;
}

bool SharpEdges::nearestFace(const btVector3& place, btScalar max_distance,
                             SurfaceQueries::Nearest& nearest) const {
  return surface->nearest(((place - origin) * axes) / scale, max_distance / scale, nearest);
}

bool SharpEdges::isIn(const btVector3& place, btScalar max_distance) const {
  SurfaceQueries::Nearest nearest;
  return nearestFace(place, max_distance, nearest) && (nearest.distance < 0) != inside_out;
}

bool SharpEdges::nearestTriangle(const btVector3& place, std::size_t& triangle) const {
  SurfaceQueries::Nearest nearest;
  if (!nearestFace(place, BT_LARGE_FLOAT, nearest)) return false;
  triangle = nearest.triangle;
  return true;
}

bool SharpEdges::depthOf(const btVector3& place, btScalar& depth) const {
  SurfaceQueries::Nearest nearest;
  if (!nearestFace(place, BT_LARGE_FLOAT, nearest)) return false;
  depth = (inside_out ? nearest.distance : -nearest.distance) * scale;
  return true;
}

bool SharpEdges::distanceOf(const btVector3& place, btScalar& distance) const {
  if (!depthOf(place, distance)) return false;
  distance = btFabs(distance);
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
