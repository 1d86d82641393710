#include "surface/smooth_normals.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr btScalar kSmooth = btScalar(0.866);  // cos 30 degrees
/// Normals that differ by less are those of a flat face, but for rounding [rad].
constexpr btScalar kFlat = btScalar(1e-4);
/// Ratio: triangles at a corner that reach further from it than others by this are of a flat face, or of a
/// straight tube, and the others of the rounding or the bend in which it ends: no cut of one curve has such
/// neighbours.
constexpr btScalar kMuchFurther = 4;
/// Ratio: a curve that was cut into facets does not turn this much more at one side of a facet than at the
/// other.
constexpr btScalar kUneven = 8;
/// Ratio: triangles around a corner of a curve that was cut turn by no more than this times what one does
/// from the next: at a tip of ten and more facets they do. Where they stay smooth with each other it is a
/// flat one, or the pole of a ball.
constexpr btScalar kTurnsFar = 3;
/// Ratio: where normals lean further than this times the angle at an edge, it is other edges that turn them.
constexpr btScalar kOwn = 2;
/// Ratio: the bends at both ends of an edge are of one surface if their mean is by less than this, of what
/// they differ by, another one than the edge's own. Where a tube goes over into the ball in which it ends it
/// is 1/2.
constexpr btScalar kOneSurface = btScalar(0.25);
/// How far beyond an edge, in weights, a line still meets a triangle, and a point is still over it: no
/// rounding leaves a gap between two, or takes the bulge from a point on a rim.
constexpr btScalar kBeyond = btScalar(1e-4);
/// Added to the triangle across a sharp edge. Instead of one across an edge that no other triangle shares.
constexpr std::uint32_t kSharp = std::uint32_t(1) << 31, kSeam = kSharp - 1;
/// Edges that are crossed to look for one, for the bulge of a triangle and for where a face ends.
constexpr std::uint32_t kCrossed = 4;
constexpr std::uint32_t kCrossedFar = 12;
/// Triangles that are walked over at most.
constexpr int kWalkedOver = 64;
/// Triangles that are looked at on the way to the one that a line meets.
constexpr int kNearby = 8;
/// In sizes of the surface: a triangle is a sliver that is no higher than what rounding of its corners makes.
constexpr btScalar kRounding = btScalar(4e-6);

btVector3 unit(const btVector3& v) {
  const btScalar length = v.length();
  return length > 0 ? v / length : btVector3(0, 0, 0);
}

constexpr std::size_t next(std::size_t k) {
  return k == 2 ? 0 : k + 1;
}

std::size_t placeOf(std::uint32_t corner, const std::array<std::uint32_t, 3>& triangle) {
  return triangle[0] == corner ? 0 : triangle[1] == corner ? 1 : 2;
}

struct LongestEdge {
  std::size_t edge = 0;
  btScalar length = 0;
};

LongestEdge longestEdge(const btVector3* corners) {
  LongestEdge longest;
  for (std::size_t k = 0; k < 3; ++k) {
    const btScalar length = corners[k].distance(corners[next(k)]);
    if (length > longest.length) longest = {k, length};
  }
  return longest;
}

}  // namespace

SmoothNormals::SmoothNormals(const Surface& surface) : facets_(surface.triangles.size()) {
  Around around(surface.vertices.size());
  for (std::size_t t = 0; t < facets_.size(); ++t) {
    for (std::uint32_t v : surface.triangles[t]) around[v].push_back(static_cast<std::uint32_t>(t));
  }
  setCorners(surface);
  layOnNeighbours(surface, around);
  setNormals(surface, around);
  setMixed(surface, around);
  setEnds(surface);
  countToSharp();
}

void SmoothNormals::setCorners(const Surface& surface) {
  btScalar size = 0;
  for (const auto& vertex : surface.vertices) {
    for (const float x : vertex) size = btMax(size, btScalar(std::fabs(x)));
  }
  for (std::size_t t = 0; t < facets_.size(); ++t) {
    Facet& facet = facets_[t];
    for (std::size_t k = 0; k < 3; ++k)
      facet.corners[k] = toBullet(surface.vertices[surface.triangles[t][k]]);
    const btVector3* const c = facet.corners;
    const btVector3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
    facet.face.setZero();
    if (normal.length() > kRounding * size * longestEdge(c).length) setFace(unit(normal), facet);
  }
}

void SmoothNormals::setFace(const btVector3& face, Facet& facet) {
  const btVector3* const c = facet.corners;
  const btScalar longest = longestEdge(c).length;
  const btScalar area = (c[1] - c[0]).cross(c[2] - c[0]).length();
  facet.face = face;
  for (std::size_t k = 0; k < 3; ++k)
    facet.inwards[k] = face.cross(c[next(k)] - c[k]) / btMax(area, SIMD_EPSILON * longest * longest);
}

/// Rounding alone would give a sliver its normal, of any direction. It belongs to the face beyond its longest
/// edge, or to that which another sliver there belongs to.
void SmoothNormals::layOnNeighbours(const Surface& surface, const Around& around) {
  std::vector<std::size_t> slivers;
  for (std::size_t t = 0; t < facets_.size(); ++t) {
    if (facets_[t].face.isZero() && longestEdge(facets_[t].corners).length > 0) slivers.push_back(t);
  }
  const auto lay = [&](std::size_t t) {
    const std::size_t edge = longestEdge(facets_[t].corners).edge;
    const std::uint32_t end = surface.triangles[t][next(edge)];
    for (const std::uint32_t other : around[surface.triangles[t][edge]]) {
      const auto& triangle = surface.triangles[other];
      const bool shares = std::find(triangle.begin(), triangle.end(), end) != triangle.end();
      if (!shares || facets_[other].face.isZero()) continue;
      setFace(facets_[other].face, facets_[t]);
      return true;
    }
    return false;
  };
  for (std::size_t before = 0; before != slivers.size();) {
    before = slivers.size();
    slivers.erase(std::remove_if(slivers.begin(), slivers.end(), lay), slivers.end());
  }
}

/// Of the curved surface at a corner of a triangle, by the triangles around it that belong to that surface.
btVector3 SmoothNormals::normalAt(const Surface& surface, const std::vector<std::uint32_t>& around,
                                  std::uint32_t corner, const Facet& facet) const {
  const auto forEach = [&](const auto& visit) {
    for (const std::uint32_t other : around) {
      if (!isSmooth(facet, facets_[other])) continue;
      const std::size_t at = placeOf(corner, surface.triangles[other]);
      const btVector3* const corners = facets_[other].corners;
      visit(corners[next(at)] - corners[at], corners[next(next(at))] - corners[at]);
    }
  };
  btScalar furthest2 = 0;
  forEach([&](const btVector3& e1, const btVector3& e2) {
    furthest2 = btMax(furthest2, btMax(e1.length2(), e2.length2()));
  });
  btVector3 sum(0, 0, 0);
  forEach([&](const btVector3& e1, const btVector3& e2) {
    if (btMax(e1.length2(), e2.length2()) * (kMuchFurther * kMuchFurther) < furthest2) return;
    // Weights of Max, "Weights for computing vertex normals from facet normals" (1999): exact on a ball,
    // however it is cut.
    const btScalar lengths = e1.length() * e2.length();
    if (lengths > 0) sum += unit(e1).cross(unit(e2)) / lengths;
  });
  return unit(sum);
}

void SmoothNormals::setAcross(const Surface& surface, const Around& around) {
  for (std::size_t t = 0; t < facets_.size(); ++t) {
    Facet& facet = facets_[t];
    for (std::size_t k = 0; k < 3; ++k) {
      facet.across[k] = kSeam;
      for (std::uint32_t other : around[surface.triangles[t][k]]) {
        const auto& triangle = surface.triangles[other];
        if (other != t &&
            std::find(triangle.begin(), triangle.end(), surface.triangles[t][next(k)]) != triangle.end())
          facet.across[k] = isSmooth(facet, facets_[other]) ? other : kSharp + other;
      }
    }
  }
}

/// By how the normals at its corners lean from a triangle's own, along the more upright of the edges that
/// lead from this one to the corner opposite: on a curved surface they do so equally at both ends.
SmoothNormals::Bend SmoothNormals::bendBeyond(std::size_t t, std::size_t k) const {
  const Facet& facet = facets_[t];
  const std::size_t opposite = next(next(k));
  const btVector3 edge = unit(facet.corners[next(k)] - facet.corners[k]);
  const btVector3 ways[] = {unit(facet.corners[opposite] - facet.corners[k]),
                            unit(facet.corners[opposite] - facet.corners[next(k)])};
  const bool from_next = btFabs(ways[1].dot(edge)) < btFabs(ways[0].dot(edge));
  const btVector3& way = ways[from_next];
  const btVector3& start = facet.normals[from_next ? next(k) : k];
  const btScalar angle = (facet.face - facets_[facet.across[k]].face).dot(way);
  const btScalar sense = angle < 0 ? btScalar(-1) : btScalar(1);
  const btScalar here = (facet.face - start).dot(way) * sense;
  if (btFabs(here) < kFlat) return Bend::none;
  if (here < 0 || here > kOwn * btFabs(angle)) return Bend::goes_on;
  const btVector3 lean = (facet.normals[opposite] - facet.face) * sense;
  // Not what leans on along the edge: the far corner may lie on a fold that meets this edge aslant.
  const btScalar there = btMin(lean.dot(way), lean.dot(unit(facet.inwards[k])));
  // Irregular cuts of a curved surface bend to and fro, but not in straight rows.
  if (there * kUneven < -here && btFabs(start.dot(edge)) * kUneven > here) return Bend::none;
  return there * kUneven < here ? Bend::ends : Bend::goes_on;
}

/// Makes sharp the edges in which faces meet that are flat across them: on neither side the bend goes on.
void SmoothNormals::findFolds(const Surface& surface, const Around& around) {
  struct Fold {
    std::uint32_t* across[2];  // from either side
    std::uint32_t ends[2];
  };
  std::vector<Fold> folds;
  std::vector<std::uint32_t> sharp_ends(surface.vertices.size());  // from each side of an edge
  for (std::uint32_t t = 0; t < facets_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& across = facets_[t].across[k];
      const std::uint32_t ends[] = {surface.triangles[t][k], surface.triangles[t][next(k)]};
      if (across >= kSeam) {
        for (const std::uint32_t v : ends) ++sharp_ends[v];
      }
      if (across >= kSeam || across < t) continue;
      std::uint32_t* const others = facets_[across].across;
      std::uint32_t* const back = std::find(others, others + 3, t);
      if (back == others + 3) continue;
      const Bend bends[] = {bendBeyond(t, k), bendBeyond(across, static_cast<std::size_t>(back - others))};
      const auto either = [&](Bend bend) { return bends[0] == bend || bends[1] == bend; };
      if (either(Bend::ends) && !either(Bend::goes_on))
        folds.push_back({{&across, back}, {ends[0], ends[1]}});
    }
  }
  const auto turn = [&](const Fold& fold, bool sharp) {
    for (std::uint32_t* const across : fold.across) *across = sharp ? *across + kSharp : *across - kSharp;
    for (const std::uint32_t v : fold.ends) sharp_ends[v] = sharp ? sharp_ends[v] + 2 : sharp_ends[v] - 2;
  };
  for (const Fold& fold : folds) turn(fold, true);
  // What ends within the surface does not part it.
  const auto endsWithin = [&](const Fold& fold) {
    const bool ends = sharp_ends[fold.ends[0]] <= 2 || sharp_ends[fold.ends[1]] <= 2;
    if (ends) turn(fold, false);
    return ends;
  };
  for (std::size_t before = folds.size() + 1; before != folds.size();) {
    before = folds.size();
    folds.erase(std::remove_if(folds.begin(), folds.end(), endsWithin), folds.end());
  }
  std::vector<bool> on_fold(surface.vertices.size());
  for (const Fold& fold : folds) {
    for (const std::uint32_t v : fold.ends) on_fold[v] = true;
  }
  for (std::uint32_t t = 0; t < facets_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = surface.triangles[t][k];
      if (on_fold[v]) facets_[t].normals[k] = normalAt(surface, fanOf(t, around[v]), v, facets_[t]);
    }
  }
  // Where these folds no longer turn normals, others may show.
  if (!folds.empty()) findFolds(surface, around);
}

/// Of the triangles around a corner, those that are reached from one of them across no sharp edge.
std::vector<std::uint32_t> SmoothNormals::fanOf(std::uint32_t t,
                                                const std::vector<std::uint32_t>& around) const {
  const auto has = [](const std::vector<std::uint32_t>& some, std::uint32_t other) {
    return std::find(some.begin(), some.end(), other) != some.end();
  };
  std::vector<std::uint32_t> reached{t};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const std::uint32_t other : facets_[reached[i]].across) {
      if (has(around, other) && !has(reached, other)) reached.push_back(other);
    }
  }
  // In the order in which normals are summed up elsewhere.
  std::vector<std::uint32_t> fan;
  std::copy_if(around.begin(), around.end(), std::back_inserter(fan),
               [&](std::uint32_t other) { return has(reached, other); });
  return fan;
}

/// Whether the triangles around a corner of one, across no sharp edge, turn far from it, each by little.
bool SmoothNormals::isTip(const Surface& surface, const std::vector<std::uint32_t>& around, std::uint32_t t,
                          std::size_t k) const {
  const auto turn2 = [&](std::uint32_t a, std::uint32_t b) {
    return (facets_[a].face - facets_[b].face).length2();
  };
  const auto isRough = [&](std::uint32_t other) { return !isSmooth(facets_[t], facets_[other]); };
  if (std::none_of(around.begin(), around.end(), isRough)) return false;
  const std::uint32_t corner = surface.triangles[t][k];
  btScalar furthest2 = 0, step2 = 0;
  bool rough = false;
  for (const bool onwards : {true, false}) {
    // From one to the next, not by fanOf(): a corner may have thousands.
    std::uint32_t here = t;
    for (std::size_t i = 0; i < around.size(); ++i) {
      const std::size_t at = placeOf(corner, surface.triangles[here]);
      const std::uint32_t other = facets_[here].across[onwards ? at : next(next(at))];
      if (other >= kSeam) break;
      step2 = btMax(step2, turn2(here, other));
      if (other == t) break;
      furthest2 = btMax(furthest2, turn2(other, t));
      rough = rough || isRough(other);
      here = other;
    }
  }
  return rough && furthest2 > kTurnsFar * kTurnsFar * step2;
}

void SmoothNormals::setNormals(const Surface& surface, const Around& around) {
  setAcross(surface, around);
  for (std::size_t t = 0; t < facets_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = surface.triangles[t][k];
      // The lines of a cone are straight up to its tip, and have the normal of their own facet there.
      const bool is_tip = isTip(surface, around[v], static_cast<std::uint32_t>(t), k);
      facets_[t].normals[k] = is_tip ? facets_[t].face : normalAt(surface, around[v], v, facets_[t]);
      if (is_tip) tips_.push_back(v);
    }
  }
  std::sort(tips_.begin(), tips_.end());
  tips_.erase(std::unique(tips_.begin(), tips_.end()), tips_.end());
  findFolds(surface, around);
  for (Facet& facet : facets_) {
    facet.curvature = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const btVector3 turn = facet.normals[next(k)] - facet.normals[k];
      const btVector3 edge = facet.corners[next(k)] - facet.corners[k];
      // The parabola with these normals along the edge; on a ball that is its height over the triangle, to
      // second order.
      facet.bulges[k] = turn.dot(edge) / 2;
      if (turn.length() < kFlat || !(edge.length2() > 0)) continue;
      const btScalar along = turn.dot(edge) / edge.length2();
      if (btFabs(along) > btFabs(facet.curvature)) facet.curvature = along;
    }
  }
}

namespace {

/// How normals turn around a vertex, by those of its neighbours.
class VertexBend {
 public:
  VertexBend() = default;
  explicit VertexBend(const btVector3& normal) : normal_(normal) { btPlaneSpace1(normal, x_, y_); }
  void add(const btVector3& edge, const btVector3& turn) {
    const btScalar weight = 1 / edge.length2(), ex = edge.dot(x_), ey = edge.dot(y_);
    xx_ += weight * ex * ex;
    xy_ += weight * ex * ey;
    yy_ += weight * ey * ey;
    by_x_ += turn * (weight * ex);
    by_y_ += turn * (weight * ey);
  }
  /// False if the neighbours lie in one direction.
  bool solve() {
    const btScalar determinant = xx_ * yy_ - xy_ * xy_;
    if (!(determinant > btScalar(0.01) * (xx_ + yy_) * (xx_ + yy_))) return false;
    const btVector3 along_x = (by_x_ * yy_ - by_y_ * xy_) / determinant,
                    along_y = (by_y_ * xx_ - by_x_ * xy_) / determinant;
    by_x_ = along_x;
    by_y_ = along_y;
    return true;
  }
  /// Along a chord: on a ball exactly so.
  btVector3 turn(const btVector3& edge) const {
    const btScalar ex = edge.dot(x_), ey = edge.dot(y_), length2 = ex * ex + ey * ey;
    if (!(length2 > 0)) return {0, 0, 0};
    const btVector3 along = by_x_ * ex + by_y_ * ey;
    const btScalar curvature = (along.dot(x_) * ex + along.dot(y_) * ey) / length2;
    return along + normal_ * (normal_.dot(edge) * curvature);
  }

 private:
  btVector3 normal_, x_, y_, by_x_{0, 0, 0}, by_y_{0, 0, 0};
  btScalar xx_ = 0, xy_ = 0, yy_ = 0;
};

}  // namespace

/// Normals that are linear within a triangle lack what bends along both of its sides at once, and lean to the
/// side to which the diagonals of a mesh lead: a torus of triangles rolled as if it went downhill. With the
/// bends B at both ends of an edge e from i to j they are right to second order:
///   n = sum w_i n_i + sum w_i w_j (B_i - B_j) e / 2.
void SmoothNormals::setMixed(const Surface& surface, const Around& around) {
  std::vector<VertexBend> bends(around.size());
  std::vector<bool> known(around.size());
  for (std::size_t v = 0; v < around.size(); ++v) {
    const auto corner = static_cast<std::uint32_t>(v);
    if (around[v].empty()) continue;
    const std::uint32_t first = around[v].front();
    const btVector3& normal = facets_[first].normals[placeOf(corner, surface.triangles[first])];
    bends[v] = VertexBend(normal);
    known[v] = true;
    for (const std::uint32_t t : around[v]) {
      const Facet& facet = facets_[t];
      const std::size_t at = placeOf(corner, surface.triangles[t]);
      const btVector3& own = facet.normals[at];
      const btVector3 edge = facet.corners[next(at)] - facet.corners[at];
      known[v] = known[v] && facet.across[at] < kSeam && facet.across[next(next(at))] < kSeam &&
                 edge.length2() > 0 && (own - normal).length() < kFlat;
      if (known[v]) bends[v].add(edge, facet.normals[next(at)] - own);
    }
    known[v] = known[v] && bends[v].solve();
  }
  mixed_.assign(facets_.size(), {});
  for (std::size_t t = 0; t < facets_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      btVector3& mixed = mixed_[t][k];
      mixed.setZero();
      const std::uint32_t from = surface.triangles[t][k], to = surface.triangles[t][next(k)];
      if (facets_[t].curvature == 0 || !known[from] || !known[to]) continue;
      const btVector3 edge = facets_[t].corners[next(k)] - facets_[t].corners[k];
      const btVector3 turns[] = {bends[from].turn(edge), bends[to].turn(edge)};
      const btVector3 differ = turns[0] - turns[1], own = facets_[t].normals[next(k)] - facets_[t].normals[k];
      if ((own - (turns[0] + turns[1]) / 2).length() < kOneSurface * differ.length()) mixed = differ / 2;
    }
  }
}

void SmoothNormals::setEnds(const Surface& surface) {
  ends_ = tips_;
  for (std::uint32_t t = 0; t < facets_.size(); ++t) {
    if (!(facets_[t].curvature > 0)) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (facets_[t].across[k] < kSharp || isValley({0, t, k})) continue;
      for (const std::size_t end : {std::size_t(k), next(k)}) ends_.push_back(surface.triangles[t][end]);
    }
  }
  std::sort(ends_.begin(), ends_.end());
  ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
}

void SmoothNormals::countToSharp() {
  for (Facet& facet : facets_) {
    const bool sharp = *std::max_element(facet.across, facet.across + 3) >= kSharp;
    facet.to_sharp = sharp ? 1 : kCrossedFar + 1;
  }
  for (std::uint32_t count = 1; count < kCrossedFar; ++count) {
    for (Facet& facet : facets_) {
      for (const std::uint32_t other : facet.across) {
        if (other < kSeam && facets_[other].to_sharp == count)
          facet.to_sharp = std::min(facet.to_sharp, count + 1);
      }
    }
  }
}

bool SmoothNormals::isSmooth(const Facet& a, const Facet& b) {
  return !(a.face.dot(b.face) < kSmooth);
}

/// False if the line is parallel to the triangle's plane.
bool SmoothNormals::crossPlane(const Facet& facet, const btVector3& from, const btVector3& direction,
                               Crossing& crossing) {
  const btScalar along = facet.face.dot(direction);
  if (along == 0) return false;
  crossing.distance = facet.face.dot(facet.corners[0] - from) / along;
  const btVector3 at = from + direction * crossing.distance;
  // Each corner's is the height over the edge across.
  for (std::size_t k = 0; k < 3; ++k)
    crossing.weights[k] = facet.inwards[next(k)].dot(at - facet.corners[next(k)]);
  return true;
}

bool SmoothNormals::cross(std::size_t t, const btVector3& from, const btVector3& direction,
                          Crossing& crossing) const {
  if (!crossPlane(facets_[t], from, direction, crossing)) return false;
  const std::array<btScalar, 3>& w = crossing.weights;
  return w[0] > -kBeyond && w[1] > -kBeyond && w[2] > -kBeyond;
}

bool SmoothNormals::crossNear(std::size_t& triangle, const btVector3& from, const btVector3& direction,
                              Crossing& crossing) const {
  std::size_t t = triangle;
  for (int i = 0; i < kNearby; ++i) {
    if (!crossPlane(facets_[t], from, direction, crossing)) return false;
    const std::array<btScalar, 3>& w = crossing.weights;
    const std::size_t corner = w[0] < w[1] ? (w[0] < w[2] ? 0 : 2) : (w[1] < w[2] ? 1 : 2);
    if (w[corner] > -kBeyond) {
      triangle = t;
      return true;
    }
    // Over the edge that it is furthest beyond.
    t = facets_[t].across[next(corner)];
    if (t >= kSeam) return false;
  }
  return false;
}

SmoothNormals::Place SmoothNormals::at(std::size_t t, const Crossing& crossing) const {
  const Facet& facet = facets_[t];
  btVector3 sum(0, 0, 0);
  btScalar bulge = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += facet.normals[k] * crossing.weights[k];
    const btScalar both = crossing.weights[k] * crossing.weights[next(k)];
    bulge += both * facet.bulges[k];
    if (facet.curvature != 0) sum += mixed_[t][k] * both;
  }
  return {unit(sum), bulge};
}

btVector3 SmoothNormals::turn(std::size_t t, const btVector3& way) const {
  const Facet& facet = facets_[t];
  btVector3 sum(0, 0, 0);
  for (std::size_t k = 0; k < 3; ++k) sum += facet.normals[k] * facet.inwards[next(k)].dot(way);
  return sum;
}

bool SmoothNormals::isPastSharpEdge(std::size_t t, const btVector3& point) const {
  for (std::uint32_t i = 0; i + facets_[t].to_sharp <= kCrossed; ++i) {
    const Facet& facet = facets_[t];
    std::size_t edge = 3;
    for (std::size_t k = 0; k < 3 && edge == 3; ++k) {
      if (facet.inwards[k].dot(point - facet.corners[k]) < -kBeyond) edge = k;
    }
    if (edge == 3) return false;
    t = facet.across[edge];
    if (t >= kSeam) return t >= kSharp;
  }
  return false;
}

/// By which a line along a triangle leaves it.
SmoothNormals::Exit SmoothNormals::exitOf(const Facet& facet, const btVector3& at, const btVector3& along) {
  Exit exit{3, BT_LARGE_FLOAT};
  for (std::size_t k = 0; k < 3; ++k) {
    const btScalar speed = -along.dot(facet.inwards[k]);
    if (!(speed > 0)) continue;
    const btScalar time = btMax(btScalar(0), (at - facet.corners[k]).dot(facet.inwards[k]) / speed);
    if (time < exit.time) exit = {k, time};
  }
  return exit;
}

SmoothNormals::Ending SmoothNormals::untilSharpEdge(std::size_t t, const btVector3& point,
                                                    const btVector3& towards) const {
  btVector3 at = point;
  btScalar way = 0;
  for (std::uint32_t i = 0; i + facets_[t].to_sharp <= kCrossedFar; ++i) {
    const Facet& facet = facets_[t];
    const btVector3 along = towards - facet.face * towards.dot(facet.face);
    const auto [edge, nearest] = exitOf(facet, at, along);
    if (edge == 3) break;
    way += nearest * along.length();
    at += along * nearest;
    if (facet.across[edge] >= kSharp)
      return {way, static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(edge)};
    t = facet.across[edge];
    if (t == kSeam) break;
  }
  return {};
}

bool SmoothNormals::walk(std::size_t t, const btVector3& point, const btVector3& way, btScalar most,
                         Walked& walked) const {
  btVector3 at = point;
  btScalar gone = 0;
  for (int i = 0; i < kWalkedOver; ++i) {
    const Facet& facet = facets_[t];
    const btVector3 along = way - facet.face * way.dot(facet.face);
    const auto [edge, nearest] = exitOf(facet, at, along);
    if (gone + nearest >= most) {
      walked = {most, static_cast<std::uint32_t>(t), kNoEdge};
      return true;
    }
    if (edge == 3) return false;
    gone += nearest;
    at += along * nearest;
    const std::uint32_t across = facet.across[edge];
    if (across >= kSharp) {
      walked = {gone, static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(edge)};
      return true;
    }
    if (across == kSeam) return false;
    t = across;
  }
  return false;
}

SmoothNormals::Ends SmoothNormals::endsOf(const Ending& ending) const {
  const btVector3* const corners = facets_[ending.triangle].corners;
  return {corners[ending.edge], corners[next(ending.edge)]};
}

bool SmoothNormals::isValley(const Ending& ending) const {
  const Facet& facet = facets_[ending.triangle];
  return facesOf(ending).inwards[1].dot(facet.face) > 0;
}

bool SmoothNormals::isSharp(std::size_t triangle, std::size_t edge) const {
  return facets_[triangle].across[edge] >= kSharp;
}

SmoothNormals::EdgeFaces SmoothNormals::facesOf(const Ending& ending) const {
  const Facet& facet = facets_[ending.triangle];
  const std::uint32_t across = facet.across[ending.edge] - kSharp;
  const Facet& other = facets_[across];
  std::size_t back = 0;
  while (back < 2 && other.across[back] != kSharp + ending.triangle) ++back;
  return {{unit(facet.inwards[ending.edge]), unit(other.inwards[back])},
          std::min(3 * ending.triangle + ending.edge, 3 * across + static_cast<std::uint32_t>(back)),
          across};
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
