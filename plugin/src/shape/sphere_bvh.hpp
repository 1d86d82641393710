// Holds spheres of a packing in a bounding volume tree, to find those near something that is not a packing.
#pragma once

#include <cstddef>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// This is Bullet's own box tree over the spheres, in the packing's frame. Const members are safe to call
/// from several threads at once.
class SphereBvh {
 public:
  /// Builds the tree of the first `count` spheres, and of others, which are counted on from there.
  SphereBvh(const std::vector<Sphere>& spheres, std::size_t count, const std::vector<Sphere>& others = {});
  SphereBvh(const SphereBvh&) = delete;
  SphereBvh& operator=(const SphereBvh&) = delete;

  /// Calls visit(index) for every sphere whose box, and those above it in the tree, enter(min, max) accepts.
  template <typename Enter, typename Visit>
  void forEach(const Enter& enter, const Visit& visit) const {
    descend(tree_.m_root, enter, visit);
  }

 private:
  void insert(const Sphere& sphere, std::size_t index);
  template <typename Enter, typename Visit>
  static void descend(const btDbvtNode* node, const Enter& enter, const Visit& visit) {
    if (!enter(node->volume.Mins(), node->volume.Maxs())) return;
    if (node->isleaf()) {
      visit(static_cast<std::size_t>(node->dataAsInt));
    } else {
      descend(node->childs[0], enter, visit);
      descend(node->childs[1], enter, visit);
    }
  }

  btDbvt tree_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
