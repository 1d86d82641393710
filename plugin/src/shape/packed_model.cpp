#include "shape/packed_model.hpp"

#include <algorithm>
#include <functional>
#include <mutex>
#include <string>

#include "common/bullet_vectors.hpp"
#include "common/log.hpp"
#include "shape/search_spheres.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// The largest distance from the surface to the nearest of the first spheres, at most so many places of it
/// looked at.
btScalar largestInset(const Packing& packing, std::size_t count) {
  constexpr std::size_t kPlaces = 1000;
  const Surface& surface = packing.surface;
  const std::size_t stride = surface.triangles.size() / kPlaces + 1;
  btScalar inset = 0;
  const auto visit = [&](const btVector3& p) {
    btScalar gap = BT_LARGE_FLOAT;
    for (std::size_t i = 0; i < count; ++i) {
      const Sphere& s = packing.spheres[i];
      gap = btMin(gap, p.distance(centre(s)) - btScalar(s.radius));
    }
    inset = btMax(inset, gap);
  };
  for (std::size_t t = 0; t < surface.triangles.size(); t += stride) {
    btVector3 corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = toBullet(surface.vertices[surface.triangles[t][k]]);
    visit(corners[0]);
    visit((corners[0] + corners[1] + corners[2]) / 3);
  }
  return inset;
}

btScalar largestOvershoot(const Packing& packing, const VolumeTrueRadii* radii) {
  btScalar overshoot = 0;
  for (std::size_t i = 0; radii != nullptr && i < radii->count; ++i) {
    overshoot = btMax(overshoot, btScalar(radii->radii[i] - packing.spheres[i].radius));
  }
  return overshoot;
}

/// Of spheres in any order.
btScalar medianRadius(const Packing& packing, std::size_t count) {
  std::vector<float> radii;
  for (std::size_t i = 0; i < count; ++i) radii.push_back(packing.spheres[i].radius);
  const auto median = radii.begin() + std::ptrdiff_t(count / 2);
  std::nth_element(radii.begin(), median, radii.end(), std::greater<float>());
  return btScalar(*median);
}

btScalar largestRadius(const Packing& packing, std::size_t count) {
  btScalar largest = 0;
  for (std::size_t i = 0; i < count; ++i) largest = btMax(largest, btScalar(packing.spheres[i].radius));
  return largest;
}

}  // namespace

Prefix::Prefix(const PackedModel& model, std::size_t sphere_count)
    : count(sphere_count),
      volume_true(volumeTrueRadii(model.packing(), sphere_count)),
      largest_overshoot(largestOvershoot(model.packing(), volume_true)),
      median_radius(medianRadius(model.packing(), sphere_count)),
      largest_radius(largestRadius(model.packing(), sphere_count)),
      model_(model) {}

void Prefix::warnOnce() const {
  std::call_once(warned_, [this] {
    const Packing& packing = model_.packing();
    const std::string bare = bareSurface(packing, count);
    if (bare.empty()) return;
    // Each world may have a model of its own of the same packing.
    logOnce("The packing of \"" + packing.provenance.source + "\" leaves parts of its solid out: " + bare +
            ". Use more of its spheres, or pack it anew, in the order of coverage.");
  });
}

const SphereBvh& Prefix::tree() const {
  return tree_.get([this] { return std::make_unique<SphereBvh>(model_.packing().spheres, count); });
}

btScalar Prefix::inset() const {
  const Packing& packing = model_.packing();
  if (count == packing.spheres.size() && packing.quality.gap_max > 0) {
    return btScalar(packing.quality.gap_max);
  }
  return inset_.get([&] { return std::make_unique<btScalar>(largestInset(packing, count)); });
}

Feelers Prefix::feelersIn(FeelerPlaces where) const {
  return placeFeelers(model_.packing(), count, inset(), model_.surfaceQueries(), where);
}

const Feelers& Prefix::feelers() const {
  return feelers_.get([this] { return std::make_unique<Feelers>(feelersIn(FeelerPlaces::all)); });
}

const Feelers& Prefix::searchFeelers() const {
  return search_feelers_.get([this] { return std::make_unique<Feelers>(feelersIn(FeelerPlaces::thin)); });
}

const SphereBvh& Prefix::feelingTree() const {
  const Feelers& more = feelers();
  if (more.balls.empty()) return tree();
  return feeling_tree_.get(
      [&] { return std::make_unique<SphereBvh>(model_.packing().spheres, count, more.balls); });
}

const CollisionModel& Prefix::searchModel() const {
  return search_model_.get([this] {
    const std::vector<Sphere>& all = model_.packing().spheres;
    auto first = std::make_shared<Packing>();
    first->order = model_.packing().order;
    first->spheres.assign(all.begin(), all.begin() + std::ptrdiff_t(count));
    const std::vector<Sphere>& more = searchFeelers().balls;
    if (!more.empty()) first->order = SphereOrder::coverage;  // radii do not fall
    first->spheres.insert(first->spheres.end(), more.begin(), more.end());
    const std::vector<Sphere> enlarged = searchSpheres(model_.packing().surface, first->spheres);
    auto model = std::make_unique<CollisionModel>(std::move(first));
    model->update(enlarged.data(), enlarged.size());
    return model;
  });
}

PackedModel::PackedModel(std::shared_ptr<const CollisionModel> collision_model)
    : model(std::move(collision_model)),
      principal(principalFrame(packing())),
      in_principal(packing(), principal.from_packing) {}

std::shared_ptr<const PackedModel> PackedModel::of(std::shared_ptr<const CollisionModel> model) {
  static std::mutex mutex;
  // Never destroyed: shapes in static storage may outlive it otherwise.
  static auto& solids = *new std::map<const CollisionModel*, std::weak_ptr<const PackedModel>>;
  const std::lock_guard<std::mutex> lock(mutex);
  for (auto known = solids.begin(); known != solids.end();) {
    known = known->second.expired() ? solids.erase(known) : std::next(known);
  }
  std::weak_ptr<const PackedModel>& known = solids[model.get()];
  std::shared_ptr<const PackedModel> solid = known.lock();
  if (!solid) known = solid = std::make_shared<const PackedModel>(std::move(model));
  return solid;
}

const Prefix& PackedModel::prefix(std::size_t count) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return prefixes_.try_emplace(count, *this, count).first->second;
}

const Prefix& PackedModel::prefixWithin(btScalar gap, const Prefix& most) const {
  if (!hasSurface()) return most;
  for (std::size_t count = 64; count < most.count; count *= 2) {
    const Prefix& shorter = prefix(count);
    if (shorter.inset() <= gap) return shorter;
  }
  return most;
}

std::size_t PackedModel::triangleNear(std::size_t sphere) const {
  const std::vector<Sphere>& spheres = packing().spheres;
  const Triangles& known = triangles_near_.get([&] {
    return std::make_unique<Triangles>(std::make_unique<std::atomic<std::uint32_t>[]>(spheres.size()));
  });
  // Several threads may look for one at once, and find the same.
  std::uint32_t found = known[sphere].load(std::memory_order_relaxed);
  if (found == 0) {
    SurfaceQueries::Nearest nearest{0, btVector3(0, 0, 0), 0, false};
    surfaceQueries().nearest(centre(spheres[sphere]), BT_LARGE_FLOAT, nearest);
    found = static_cast<std::uint32_t>(nearest.triangle) + 1;
    known[sphere].store(found, std::memory_order_relaxed);
  }
  return found - 1;
}

const VertexHillClimb& PackedModel::vertexHillClimb() const {
  return vertex_hill_climb_.get([this] { return std::make_unique<VertexHillClimb>(packing().surface); });
}

const SupportBounds& PackedModel::bounds() const {
  return bounds_.get([this] { return std::make_unique<SupportBounds>(packing(), principal.from_packing); });
}

PackedModel::Built PackedModel::built() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool spheres = std::any_of(prefixes_.begin(), prefixes_.end(),
                                   [](const auto& prefix) { return prefix.second.hasTree(); });
  return {spheres, surface_queries_.made(), vertex_hill_climb_.made()};
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
