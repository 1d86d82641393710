#include "query/surface_query.hpp"

#include <algorithm>
#include <string>

#include "core/pair_setup.hpp"
#include "grid/model_impl.hpp"
#include "innersphere/error.hpp"
#include "surface/shared_volume.hpp"

namespace innersphere {

namespace {

constexpr std::size_t kSurfaceGrain = 1;  ///< queries that one thread takes at once: they differ much in work

PlacedSurface placedSurface(const CollisionModel& model, const Placement& placement, const Vec3d& origin) {
  core::Mat3<double> rotation;
  std::copy(placement.rotation.begin(), placement.rotation.end(), rotation.m);
  core::makeRotation(rotation);
  return {model.impl().surface(), {core::scaled(rotation, placement.scale), placement.translation - origin}};
}

Overlap overlapOf(const PairQuery& query, bool volume_only) {
  const Vec3d& origin = query.placement_a.translation;
  const PlacedSurface a = placedSurface(*query.a, query.placement_a, origin);
  const PlacedSurface b = placedSurface(*query.b, query.placement_b, origin);
  const SharedSums sums = sharedVolume(a, b);
  Overlap overlap;
  if (!(sums.volume > 0)) return overlap;
  overlap.pair_count = sums.pairs;
  overlap.volume = sums.volume;
  overlap.centroid = (1 / sums.volume) * sums.moment;
  if (volume_only) return overlap;
  overlap.energy = sums.volume;
  overlap.area = overlap.force = -sums.area;
  overlap.torque = cross(b.place.translation, sums.area) - sums.turning;
  overlap.stiffness = sums.wetted;
  return overlap;
}

}  // namespace

void SurfaceQueries::keep(const PairQuery* queries, std::size_t count, const QueryOptions& options) {
  queries_.clear();
  if (options.estimator != Estimator::surface || options.want == Want::touch) return;
  for (std::size_t i = 0; i < count; ++i) {
    const auto where = [&] { return "query " + std::to_string(i) + ": "; };
    if (queries[i].margin > 0)
      throw Error(ErrorCode::bad_argument, where() + "a margin grows spheres, not surfaces");
    try {
      queries[i].a->impl().surface();
      queries[i].b->impl().surface();
    } catch (const Error& error) {
      throw Error(error.code(), where() + error.what());
    }
  }
  queries_.assign(queries, queries + count);
  volume_only_ = options.want == Want::volume;
}

void SurfaceQueries::refine(Workers& workers, std::vector<Overlap>& overlaps) const {
  if (queries_.empty()) return;
  overlaps.resize(queries_.size());
  workers.forRanges(queries_.size(), kSurfaceGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) overlaps[i] = overlapOf(queries_[i], volume_only_);
  });
}

}  // namespace innersphere
