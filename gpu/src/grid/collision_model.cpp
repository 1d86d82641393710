#include "innersphere/collision_model.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>

#include "grid/model_impl.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

namespace {

constexpr float kLargest = 1e15f;  ///< leaves room for squares and margins in single precision [m]

bool isTooLarge(const Sphere& s) {
  return std::fabs(s.x) > kLargest || std::fabs(s.y) > kLargest || std::fabs(s.z) > kLargest ||
         s.radius > kLargest;
}

[[noreturn]] void tooLarge(const std::string& what) {
  throw Error(ErrorCode::bad_argument, what + " is beyond 1e15 m; scale the packing down");
}

/// True if all can be moved spheres of a model whose radii may go from `least` to `most`. Without branches,
/// so that the compiler takes several at once; each comparison is false for what is not a number.
bool allUsable(const Sphere* spheres, std::size_t count, float least, float most) {
  unsigned bad = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Sphere& s = spheres[i];
    bad |= static_cast<unsigned>(!(std::fabs(s.x) <= kLargest)) |
           static_cast<unsigned>(!(std::fabs(s.y) <= kLargest)) |
           static_cast<unsigned>(!(std::fabs(s.z) <= kLargest)) |
           static_cast<unsigned>(!(s.radius >= least)) | static_cast<unsigned>(!(s.radius <= most));
  }
  return bad == 0;
}

/// By the divergence theorem: the tetrahedra from one corner to all triangles.
double volumeOf(const Surface& surface) {
  if (surface.triangles.empty()) return 0;
  const auto corner = [&](std::uint32_t vertex) {
    const auto& v = surface.vertices[vertex];
    return Vec3d{v[0], v[1], v[2]};
  };
  const Vec3d from = corner(surface.triangles[0][0]);
  double sum = 0;
  for (const auto& t : surface.triangles)
    sum += dot(corner(t[0]) - from, cross(corner(t[1]) - from, corner(t[2]) - from)) / 6;
  return sum;
}

void checkMoved(const Sphere& s, std::size_t number) {
  const auto where = [&] { return "sphere " + std::to_string(number); };
  if (!std::isfinite(s.x) || !std::isfinite(s.y) || !std::isfinite(s.z) || !std::isfinite(s.radius))
    throw Error(ErrorCode::not_finite, where() + " has a number that is not finite");
  if (!(s.radius > 0)) throw Error(ErrorCode::bad_argument, where() + " has a radius that is not positive");
  if (isTooLarge(s)) tooLarge(where());
}

}  // namespace

std::uint64_t newVersion() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

CollisionModel::Impl::Impl(std::shared_ptr<const Packing> p) : packing(std::move(p)) {
  if (!packing) throw Error(ErrorCode::bad_argument, "a collision model needs a packing, not a null pointer");
  validate(*packing);
  if (packing->spheres.size() >= std::size_t{1} << 29) {
    throw Error(ErrorCode::bad_argument, "the packing has 2^29 spheres or more; use fewer");
  }
  for (std::size_t i = 0; i < packing->spheres.size(); ++i) {
    if (isTooLarge(packing->spheres[i])) tooLarge("sphere " + std::to_string(i));
  }
  for (const VolumeTrueRadii& radii : packing->volume_true) {
    for (float r : radii.radii) {
      if (r > kLargest) tooLarge("a volume-true radius of prefix " + std::to_string(radii.count));
    }
  }
  setUsualRadii();
}

/// Volume-true radii grow with the spheres. Between half and twice what they can bear nobody need look at
/// each.
void CollisionModel::Impl::setUsualRadii() {
  double smallest = 1, largest = 1;  // a volume-true radius over that of its sphere
  for (const VolumeTrueRadii& radii : packing->volume_true) {
    for (std::size_t i = 0; i < radii.count; ++i) {
      const double growth = double{radii.radii[i]} / packing->spheres[i].radius;
      smallest = std::min(smallest, growth);
      largest = std::max(largest, growth);
    }
  }
  constexpr float kSmallest = std::numeric_limits<float>::min();
  usual_radii_ = {static_cast<float>(2 * kSmallest / smallest), static_cast<float>(kLargest / 2 / largest)};
}

const ModelGrid& CollisionModel::Impl::grid(std::uint32_t prefix, Estimator estimator) {
  const std::size_t all = packing->spheres.size();
  std::size_t count = prefix == 0 || prefix > all ? all : prefix;
  const VolumeTrueRadii* radii =
      estimator == Estimator::volume_true ? volumeTrueRadii(*packing, count) : nullptr;
  if (radii) count = radii->count;
  const std::lock_guard lock(mutex_);
  return grids_.try_emplace(Key(static_cast<std::uint32_t>(count), radii), *this, count, radii).first->second;
}

const SurfaceTree& CollisionModel::Impl::surface() {
  if (!moved_.empty()) {
    throw Error(ErrorCode::bad_argument,
                "the spheres were updated, and the triangles were not; use another estimator");
  }
  const std::lock_guard lock(mutex_);
  if (!surface_) surface_.emplace(packing->surface);
  return *surface_;
}

bool CollisionModel::Impl::surfaceHasVolumeOfSolid() {
  constexpr double kOff = 1e-3;  ///< well above single precision; the packer trusts triangles up to there
  const std::lock_guard lock(mutex_);
  if (!surface_has_volume_of_solid_) {
    const double volume = packing->solid.volume;
    surface_has_volume_of_solid_ = std::abs(volumeOf(packing->surface) - volume) < kOff * volume;
  }
  return *surface_has_volume_of_solid_;
}

void CollisionModel::Impl::withSpheres(std::size_t count, const VolumeTrueRadii* radii, const Use& use) {
  // Isolated: while it waits for its own tasks, this thread must not pick up a caller's task that wants the
  // same grid.
  const auto isolated = [&](const Sphere* spheres, GridScratch& scratch) {
    tbb::this_task_arena::isolate([&] { use(spheres, scratch); });
  };
  const auto withRadii = [&](const std::vector<Sphere>& from, std::vector<Sphere>& to) {
    to.assign(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = 0; i < count; ++i) to[i].radius = radiusOf(i, *radii);
    return to.data();
  };
  if (moved_.empty()) {
    GridScratch scratch;
    std::vector<Sphere> spheres;
    return isolated(radii ? withRadii(packing->spheres, spheres) : packing->spheres.data(), scratch);
  }
  const std::lock_guard lock(scratch_.mutex);
  isolated(radii ? withRadii(moved_, scratch_.spheres) : moved_.data(), scratch_.grid);
}

/// Spheres with their own radii leave gaps: they find less. Of moved ones nobody knows what they stand for.
double CollisionModel::Impl::volume(const VolumeTrueRadii* radii) const {
  return radii && moved_.empty() ? std::max(packing->solid.volume, 0.0) : 0;
}

float CollisionModel::Impl::radiusOf(std::size_t sphere, const VolumeTrueRadii& radii) const {
  if (moved_.empty()) return radii.radii[sphere];
  return static_cast<float>(double{radii.radii[sphere]} * moved_[sphere].radius /
                            packing->spheres[sphere].radius);
}

void CollisionModel::Impl::update(const Sphere* spheres, std::size_t count) {
  if (!spheres) throw Error(ErrorCode::bad_argument, "the moved spheres are a null pointer");
  if (count != packing->spheres.size()) {
    throw Error(ErrorCode::bad_argument, "there are " + std::to_string(count) +
                                             " moved spheres for a packing of " +
                                             std::to_string(packing->spheres.size()));
  }
  if (!allUsable(spheres, count, usual_radii_.least, usual_radii_.most)) checkEach(spheres, count);
  moved_.assign(spheres, spheres + count);
  version_ = newVersion();
}

/// Throws what update() throws for the first sphere that cannot be.
void CollisionModel::Impl::checkEach(const Sphere* spheres, std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) checkMoved(spheres[i], i);
  for (const VolumeTrueRadii& radii : packing->volume_true) {
    for (std::size_t i = 0; i < radii.count; ++i) {
      const double grown = double{spheres[i].radius} / packing->spheres[i].radius;
      const double radius = radii.radii[i] * grown;
      if (!(radius <= kLargest)) tooLarge("the volume-true radius of sphere " + std::to_string(i));
      if (static_cast<float>(radius) == 0) {
        throw Error(ErrorCode::bad_argument,
                    "sphere " + std::to_string(i) + " became too small for a radius; scale the packing up");
      }
    }
  }
}

CollisionModel::CollisionModel(std::shared_ptr<const Packing> packing)
    : impl_(std::make_unique<Impl>(std::move(packing))) {}
CollisionModel::~CollisionModel() = default;

const Packing& CollisionModel::packing() const {
  return *impl_->packing;
}

void CollisionModel::update(const Sphere* spheres, std::size_t count) {
  impl_->update(spheres, count);
}

}  // namespace innersphere
