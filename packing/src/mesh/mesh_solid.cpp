#include "mesh/mesh_solid.hpp"

#include <algorithm>
#include <array>

#include "common/bounds.hpp"
#include "common/hash.hpp"
#include "mesh/mass_properties.hpp"

namespace innersphere {
namespace {

// Cells along the longest side when a mesh is searched for points that it winds around more than once.
constexpr int kOverlapCells = 64;

// The points that were looked at last tell of the next one: the neighbours of a cell.
constexpr std::size_t kKnown = 32;

// More than the rounding of distances, in diagonals.
constexpr double kRounding = 1e-12;

}  // namespace

MeshSolid::MeshSolid(Mesh closed, const std::string& name, bool count_once)
    : mesh_(std::move(closed)),
      name_(name),
      count_once_(count_once),
      bounds_(emptyBounds()),
      tree_(mesh_),
      winding_(mesh_) {
  for (const Vec3d& v : mesh_.vertices) extend(bounds_, v);
  Moments moments = momentsOf(mesh_);
  if (count_once) {
    // The divergence theorem integrates the winding number; the solid counts as 1 where that exceeds 1/2.
    // Within its distance from the surface the number around a point does not change.
    struct Known {
      Vec3d at;
      double distance, winding;
    };
    std::array<Known, kKnown> known;
    std::size_t count = 0;
    const double rounding = kRounding * (diagonal(bounds_) + norm(bounds_.min));
    moments.add(integrate(bounds_, kOverlapCells, [&](const Vec3d& p, double reach, double) {
      const double distance = tree_.closest(p, reach).distance, clear = std::min(distance, reach);
      const auto end = known.begin() + static_cast<std::ptrdiff_t>(std::min(count, kKnown));
      const auto same = std::find_if(known.begin(), end, [&](const Known& other) {
        return norm(p - other.at) < clear + other.distance - rounding;
      });
      const double winding = same != end ? same->winding : std::round(winding_.windingNumber(p));
      known[count++ % kKnown] = {p, clear, winding};
      return Probe{(winding > 0.5 ? 1 : 0) - winding, distance};
    }));
  }
  mass_ = moments.massProperties();
}

ClosestPoint MeshSolid::closestPoint(const Vec3d& p, double cutoff) const {
  return tree_.closest(p, cutoff);
}

bool MeshSolid::contains(const Vec3d& p) const {
  if (!holds(bounds_, p)) return false;
  const Triangle* nearest =
      count_once_ ? nullptr : tree_.closest(p, std::numeric_limits<double>::infinity()).triangle;
  return nearest ? contains(p, *nearest) : winding_.windingNumber(p) > 0.5;
}

bool MeshSolid::contains(const Vec3d& p, const Triangle& nearest) const {
  if (!holds(bounds_, p)) return false;
  // The winding number is expensive where large triangles lie beside small ones. Where no triangle passes
  // through another, the nearest one tells the side, unless that is nearest with its edge.
  const int side = count_once_ ? 0 : tree_.sideOf(p, nearest);
  return side != 0 ? side < 0 : winding_.windingNumber(p) > 0.5;
}

std::string MeshSolid::hash() const {
  Hash hash;
  for (const Vec3d& v : mesh_.vertices) {
    for (double x : v) hash.add(x);
  }
  for (const auto& t : mesh_.triangles) {
    for (std::uint32_t v : t) hash.add(std::uint64_t{v});
  }
  return hash.text();
}

}  // namespace innersphere
