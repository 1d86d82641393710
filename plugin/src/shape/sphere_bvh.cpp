#include "shape/sphere_bvh.hpp"

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

SphereBvh::SphereBvh(const std::vector<Sphere>& spheres, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    btDbvtNode* leaf =
        tree_.insert(btDbvtVolume::FromCR(centre(spheres[i]), btScalar(spheres[i].radius)), nullptr);
    leaf->dataAsInt = static_cast<int>(i);
  }
  tree_.optimizeTopDown();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
