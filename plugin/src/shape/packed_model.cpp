#include "shape/packed_model.hpp"

#include <algorithm>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// The largest distance from the surface to the nearest of the first spheres, at most so many places of it
/// looked at.
btScalar measureRecess(const Packing& packing, std::size_t count) {
  constexpr std::size_t kPlaces = 1000;
  const Surface& surface = packing.surface;
  const std::size_t stride = surface.triangles.size() / kPlaces + 1;
  btScalar recess = 0;
  const auto look = [&](const btVector3& p) {
    btScalar gap = BT_LARGE_FLOAT;
    for (std::size_t i = 0; i < count; ++i) {
      const Sphere& s = packing.spheres[i];
      gap = btMin(gap, p.distance(centre(s)) - btScalar(s.radius));
    }
    recess = btMax(recess, gap);
  };
  for (std::size_t t = 0; t < surface.triangles.size(); t += stride) {
    btVector3 corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = toBullet(surface.vertices[surface.triangles[t][k]]);
    look(corners[0]);
    look((corners[0] + corners[1] + corners[2]) / 3);
  }
  return recess;
}

btScalar largestBulge(const Packing& packing, const VolumeTrueRadii* radii) {
  btScalar bulge = 0;
  for (std::size_t i = 0; radii != nullptr && i < radii->count; ++i) {
    bulge = btMax(bulge, btScalar(radii->radii[i] - packing.spheres[i].radius));
  }
  return bulge;
}

}  // namespace

Prefix::Prefix(const Packing& packing, std::size_t sphere_count)
    : count(sphere_count),
      volume_true(volumeTrueRadii(packing, sphere_count)),
      largest_bulge(largestBulge(packing, volume_true)),
      median_radius(btScalar(packing.spheres[sphere_count / 2].radius)),
      packing_(packing) {}

const SphereTree& Prefix::tree() const {
  return tree_.get([this] { return std::make_unique<SphereTree>(packing_.spheres, count); });
}

btScalar Prefix::recess() const {
  if (count == packing_.spheres.size() && packing_.quality.gap_max > 0) {
    return btScalar(packing_.quality.gap_max);
  }
  return recess_.get([this] { return std::make_unique<btScalar>(measureRecess(packing_, count)); });
}

PackedSolid::PackedSolid(std::shared_ptr<const CollisionModel> collision_model)
    : model(std::move(collision_model)),
      principal(principalFrame(packing())),
      in_principal(packing(), principal.from_packing) {}

std::shared_ptr<const PackedSolid> PackedSolid::of(std::shared_ptr<const CollisionModel> model) {
  static std::mutex mutex;
  // Never destroyed: shapes in static storage may outlive it otherwise.
  static auto& solids = *new std::map<const CollisionModel*, std::weak_ptr<const PackedSolid>>;
  const std::lock_guard<std::mutex> lock(mutex);
  for (auto known = solids.begin(); known != solids.end();) {
    known = known->second.expired() ? solids.erase(known) : std::next(known);
  }
  std::weak_ptr<const PackedSolid>& known = solids[model.get()];
  std::shared_ptr<const PackedSolid> solid = known.lock();
  if (!solid) known = solid = std::make_shared<const PackedSolid>(std::move(model));
  return solid;
}

const Prefix& PackedSolid::prefix(std::size_t count) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return prefixes_.try_emplace(count, packing(), count).first->second;
}

const Prefix& PackedSolid::prefixWithin(btScalar gap, const Prefix& most) const {
  if (!hasSurface()) return most;
  for (std::size_t count = 64; count < most.count; count *= 2) {
    const Prefix& shorter = prefix(count);
    if (shorter.recess() <= gap) return shorter;
  }
  return most;
}

const SurfaceTree& PackedSolid::surfaceTree() const {
  return surface_tree_.get([this] { return std::make_unique<SurfaceTree>(packing().surface); });
}

std::size_t PackedSolid::triangleNear(std::size_t sphere) const {
  const std::vector<Sphere>& spheres = packing().spheres;
  const Triangles& known = triangles_near_.get([&] {
    return std::make_unique<Triangles>(std::make_unique<std::atomic<std::uint32_t>[]>(spheres.size()));
  });
  // Several threads may look for one at once, and find the same.
  std::uint32_t found = known[sphere].load(std::memory_order_relaxed);
  if (found == 0) {
    SurfaceTree::Nearest nearest{0, btVector3(0, 0, 0), 0, false};
    surfaceTree().nearest(centre(spheres[sphere]), BT_LARGE_FLOAT, nearest);
    found = static_cast<std::uint32_t>(nearest.triangle) + 1;
    known[sphere].store(found, std::memory_order_relaxed);
  }
  return found - 1;
}

const VertexClimb& PackedSolid::vertexClimb() const {
  return vertex_climb_.get([this] { return std::make_unique<VertexClimb>(packing().surface); });
}

PackedSolid::Built PackedSolid::built() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool spheres = std::any_of(prefixes_.begin(), prefixes_.end(),
                                   [](const auto& prefix) { return prefix.second.hasTree(); });
  return {spheres, surface_tree_.made(), vertex_climb_.made()};
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
