#include "shape/search_spheres.hpp"

#include <algorithm>
#include <array>

#include "common/bullet_vectors.hpp"
#include "shape/sphere_bvh.hpp"
#include "surface/surface_queries.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// In sizes of the solid: a piece of the surface is cut until the sphere it goes to is not further away than
/// the nearest by more than this, anywhere on it.
constexpr btScalar kSlack = btScalar(2e-3);

/// In radii: spheres of a packing are enlarged by one in the median. Where it is more than this, they are
/// small balls with wide gaps.
constexpr btScalar kWideGaps = 2;

/// This is a place of the surface.
struct CoveredPlace {
  btVector3 at;
  std::size_t sphere;  ///< the nearest
  btScalar gap;        ///< to it [m], negative inside
};
using Piece = std::array<CoveredPlace, 3>;  ///< a triangle

/// Enlarges spheres, piece by piece of the surface.
class Cover {
 public:
  Cover(const std::vector<Sphere>& spheres, btScalar slack)
      : spheres_(spheres), tree_(spheres, spheres.size()), slack_(slack), excess_(spheres.size(), 0) {}

  CoveredPlace placeAt(const btVector3& at);
  /// Enlarges a sphere until it holds the piece, or does that with both halves of the piece.
  void add(const Piece& piece);
  /// Enlarges all spheres alike, if there are wide gaps between them: balls much larger than the spheres that
  /// they come from point aside, where they meet others, unless those behind them do so, too.
  void closeWideGaps();
  /// Returns by how much a sphere is enlarged [m].
  btScalar excess(std::size_t sphere) const { return excess_[sphere]; }

 private:
  btScalar gap(const btVector3& at, std::size_t i) const {
    return at.distance(centre(spheres_[i])) - btScalar(spheres_[i].radius);
  }
  /// Returns false if numbers are too large to be told apart.
  bool addHalves(const Piece& piece);

  const std::vector<Sphere>& spheres_;
  const SphereBvh tree_;
  const btScalar slack_;  ///< [m]
  std::vector<btScalar> excess_;
  std::size_t last_ = 0;  ///< nearest to the last place, and mostly near the next
};

CoveredPlace Cover::placeAt(const btVector3& at) {
  CoveredPlace place{at, last_, gap(at, last_)};
  const auto isNear = [&](const btVector3& min, const btVector3& max) {
    btVector3 beyond = min - at;
    beyond.setMax(at - max);
    beyond.setMax(btVector3(0, 0, 0));
    return !(beyond.length2() > place.gap * place.gap);
  };
  tree_.forEach(isNear, [&](std::size_t i) {
    const btScalar here = gap(at, i);
    if (here < place.gap) place.sphere = i, place.gap = here;
  });
  last_ = place.sphere;
  return place;
}

void Cover::add(const Piece& piece) {
  std::size_t best = 0;
  btScalar least = BT_LARGE_FLOAT, slack = 0;
  for (const CoveredPlace& corner : piece) {
    // The distance from a centre is convex: on a triangle it is largest at a corner.
    btScalar needed = 0, beyond_nearest = 0;
    for (const CoveredPlace& place : piece) {
      const btScalar here = gap(place.at, corner.sphere);
      needed = btMax(needed, here);
      beyond_nearest = btMax(beyond_nearest, here - place.gap);
    }
    if (needed <= excess_[corner.sphere]) return;
    if (needed < least) best = corner.sphere, least = needed, slack = beyond_nearest;
  }
  if (!(slack > slack_) || !addHalves(piece)) excess_[best] = least;
}

bool Cover::addHalves(const Piece& piece) {
  std::size_t longest = 0;
  btScalar length2 = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const btScalar here = piece[k].at.distance2(piece[(k + 1) % 3].at);
    if (here > length2) longest = k, length2 = here;
  }
  const std::size_t next = (longest + 1) % 3;
  const CoveredPlace middle = placeAt((piece[longest].at + piece[next].at) / 2);
  if (middle.at == piece[longest].at || middle.at == piece[next].at) return false;
  for (const std::size_t replaced : {next, longest}) {
    Piece half = piece;
    half[replaced] = middle;
    add(half);
  }
  return true;
}

void Cover::closeWideGaps() {
  std::vector<btScalar> in_radii;
  for (std::size_t i = 0; i < excess_.size(); ++i) {
    if (excess_[i] > 0) in_radii.push_back(excess_[i] / btScalar(spheres_[i].radius));
  }
  if (in_radii.empty()) return;
  const auto median = in_radii.begin() + std::ptrdiff_t(in_radii.size() / 2);
  std::nth_element(in_radii.begin(), median, in_radii.end());
  if (*median > kWideGaps)
    std::fill(excess_.begin(), excess_.end(), *std::max_element(excess_.begin(), excess_.end()));
}

}  // namespace

std::vector<Sphere> searchSpheres(const Surface& surface, std::vector<Sphere> spheres) {
  Cover cover(spheres, kSlack * diagonalOf(surface));
  std::vector<CoveredPlace> corners;
  corners.reserve(surface.vertices.size());
  for (const auto& vertex : surface.vertices) corners.push_back(cover.placeAt(toBullet(vertex)));
  for (const auto& t : surface.triangles) cover.add({corners[t[0]], corners[t[1]], corners[t[2]]});
  cover.closeWideGaps();
  for (std::size_t i = 0; i < spheres.size(); ++i) spheres[i].radius += static_cast<float>(cover.excess(i));
  return spheres;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
