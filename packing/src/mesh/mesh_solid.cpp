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

MeshSolid::MeshSolid(Mesh closed, const std::string& name, bool count_once, const std::vector<bool>& touched)
    : mesh_(std::move(closed)),
      name_(name),
      bounds_(emptyBounds()),
      tree_(mesh_),
      winding_(mesh_),
      beside_(findBeside(mesh_, touched, count_once, tree_, winding_)) {
  for (const Vec3d& v : mesh_.vertices) extend(bounds_, v);
  Moments moments = momentsOf(mesh_);
  const double all_shells = moments.volume;
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
      const ClosestTriangle::Nearest nearest = tree_.closest(p, reach);
      const double distance = nearest.distance, clear = std::min(distance, reach);
      const auto end = known.begin() + static_cast<std::ptrdiff_t>(std::min(count, kKnown));
      const auto same = std::find_if(known.begin(), end, [&](const Known& other) {
        return norm(p - other.at) < clear + other.distance - rounding;
      });
      const double winding = same != end ? same->winding : std::round(windingNumber(p, nearest.triangle));
      known[count++ % kKnown] = {p, clear, winding};
      return Probe{(winding > 0.5 ? 1 : 0) - winding, distance};
    }));
  }
  mass_ = moments.massProperties();
  if (mass_.volume > 0) shared_part_ = (all_shells - mass_.volume) / mass_.volume;
}

ClosestPoint MeshSolid::closestPoint(const Vec3d& p, double cutoff) const {
  return tree_.closest(p, cutoff);
}

bool MeshSolid::contains(const Vec3d& p) const {
  return holds(bounds_, p) &&
         contains(p, *tree_.closest(p, std::numeric_limits<double>::infinity()).triangle);
}

bool MeshSolid::contains(const Vec3d& p, const Triangle& nearest) const {
  return holds(bounds_, p) && windingNumber(p, &nearest) > 0.5;
}

double MeshSolid::windingNumber(const Vec3d& p, const Triangle* nearest) const {
  // It is expensive where large triangles lie beside small ones. The nearest triangle tells it, unless that
  // is nearest with a sharp edge, or touches another one.
  if (nearest) {
    const BesideTriangle& beside = beside_[tree_.indexOf(*nearest)];
    const int side = tree_.sideOf(p, *nearest, beside.gentle);
    if (side != 0 && beside.winding_in_front != kUnknownWinding)
      return beside.winding_in_front + (side < 0 ? 1 : 0);
  }
  return winding_.windingNumber(p);
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
