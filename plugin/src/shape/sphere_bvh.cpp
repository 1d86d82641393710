#include "shape/sphere_bvh.hpp"

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Spheres that Bullet joins pair by pair, in cubic time; it cuts more than these in two. By its default of
/// 128 a tree takes 50 times as long, and is searched no faster than by a hundredth.
constexpr int kJoinedInPairs = 32;

}  // namespace

SphereBvh::SphereBvh(const std::vector<Sphere>& spheres, std::size_t count,
                     const std::vector<Sphere>& others) {
  for (std::size_t i = 0; i < count; ++i) insert(spheres[i], i);
  for (std::size_t i = 0; i < others.size(); ++i) insert(others[i], count + i);
  tree_.optimizeTopDown(kJoinedInPairs);
}

void SphereBvh::insert(const Sphere& sphere, std::size_t index) {
  btDbvtNode* leaf = tree_.insert(btDbvtVolume::FromCR(centre(sphere), btScalar(sphere.radius)), nullptr);
  leaf->dataAsInt = static_cast<int>(index);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
