#include "innersphere/collision_model.hpp"

#include <tbb/task_arena.h>

#include <cmath>
#include <string>

#include "innersphere/error.hpp"
#include "model_impl.hpp"

namespace innersphere {

CollisionModel::Impl::Impl(std::shared_ptr<const Packing> p) : packing(std::move(p)) {
  if (!packing) throw Error(ErrorCode::bad_argument, "a collision model needs a packing, not a null pointer");
  validate(*packing);
  if (packing->spheres.size() >= std::size_t{1} << 29) {
    throw Error(ErrorCode::bad_argument, "the packing has 2^29 spheres or more; use fewer");
  }
  constexpr float kLargest = 1e15f;  // leaves room for squares and margins in single precision
  const auto check = [](float x, const std::string& what) {
    if (std::fabs(x) > kLargest)
      throw Error(ErrorCode::bad_argument, what + " is beyond 1e15 m; scale the packing down");
  };
  for (std::size_t i = 0; i < packing->spheres.size(); ++i) {
    const Sphere& s = packing->spheres[i];
    for (float x : {s.x, s.y, s.z, s.radius}) check(x, "sphere " + std::to_string(i));
  }
  for (const VolumeTrueRadii& radii : packing->volume_true) {
    for (float r : radii.radii) check(r, "a volume-true radius of prefix " + std::to_string(radii.count));
  }
}

const HashGrid& CollisionModel::Impl::grid(std::uint32_t prefix, Estimator estimator) {
  const std::size_t all = packing->spheres.size();
  std::size_t count = prefix == 0 || prefix > all ? all : prefix;
  const VolumeTrueRadii* radii =
      estimator == Estimator::volume_true ? volumeTrueRadii(*packing, count) : nullptr;
  if (radii) count = radii->count;

  Entry* entry;
  {
    const std::lock_guard lock(mutex_);
    entry = &grids_[Key(static_cast<std::uint32_t>(count), radii)];
  }
  std::call_once(entry->built, [&] {
    std::vector<Sphere> spheres(packing->spheres.begin(),
                                packing->spheres.begin() + static_cast<std::ptrdiff_t>(count));
    if (radii) {
      for (std::size_t i = 0; i < count; ++i) spheres[i].radius = radii->radii[i];
    }
    // Isolated: while it waits for its own tasks, this thread must not pick up a caller's task that wants the
    // same grid.
    tbb::this_task_arena::isolate([&] { entry->grid = std::make_unique<HashGrid>(std::move(spheres)); });
  });
  return *entry->grid;
}

CollisionModel::CollisionModel(std::shared_ptr<const Packing> packing)
    : impl_(std::make_unique<Impl>(std::move(packing))) {}
CollisionModel::~CollisionModel() = default;

const Packing& CollisionModel::packing() const {
  return *impl_->packing;
}

}  // namespace innersphere
