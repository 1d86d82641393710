#include "shape/support_bounds.hpp"

#include <algorithm>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

SupportBounds::SupportBounds(const Packing& packing, const btTransform& from_packing) {
  // Numbers in rows, for compilers to take several at a time.
  std::array<btScalar, kFaces * kFace> x, y, z, length;
  for (int i = 0; i < kFaces * kFace; ++i) {
    const int face = i / kFace, axis = face / 2;
    btVector3 direction;
    direction[axis] = btScalar(face % 2 == 0 ? 1 : -1);
    direction[(axis + 1) % 3] = btScalar(i % kRow) / kCells * 2 - 1;
    direction[(axis + 2) % 3] = btScalar(i % kFace / kRow) / kCells * 2 - 1;
    x[i] = direction.x(), y[i] = direction.y(), z[i] = direction.z();
    length[i] = direction.length();
  }
  reach_.fill(-BT_LARGE_FLOAT);
  const auto add = [&](const btVector3& p, btScalar radius) {
    for (int i = 0; i < kFaces * kFace; ++i) {
      const btScalar reach = p.x() * x[i] + p.y() * y[i] + p.z() * z[i] + radius * length[i];
      reach_[i] = reach > reach_[i] ? reach : reach_[i];
    }
  };
  for (const auto& vertex : packing.surface.vertices) add(from_packing(toBullet(vertex)), 0);
  for (const Sphere& s : packing.spheres) add(from_packing(centre(s)), btScalar(s.radius));
}

btScalar SupportBounds::along(const btVector3& direction) const {
  const int axis = direction.absolute().maxAxis();
  const btScalar length = btFabs(direction[axis]);
  const auto place = [&](int i) { return (direction[(axis + i) % 3] / length + 1) * (btScalar(kCells) / 2); };
  // Of what is not finite, too.
  const auto cell = [](btScalar at) {
    return at > 0 ? static_cast<int>(std::min(at, btScalar(kCells - 1))) : 0;
  };
  const btScalar column = place(1), row = place(2);
  const int left = cell(column), low = cell(row);
  const btScalar* at = &reach_[static_cast<std::size_t>((2 * axis + (direction[axis] > 0 ? 0 : 1)) * kFace +
                                                        low * kRow + left)];
  const btScalar right = column - btScalar(left), up = row - btScalar(low);
  const btScalar below = at[0] + right * (at[1] - at[0]);
  const btScalar above = at[kRow] + right * (at[kRow + 1] - at[kRow]);
  return length * (below + up * (above - below));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
