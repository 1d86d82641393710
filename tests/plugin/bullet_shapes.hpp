// One of every kind of shape that Bullet has.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <LinearMath/btTransform.h>

namespace innersphere::test {

/// Something to fall on whose top is at the origin: flat, or round about it.
struct BulletShape {
  std::shared_ptr<btCollisionShape> shape;
  btTransform place = btTransform::getIdentity();
  std::shared_ptr<void> data = nullptr;  ///< what the shape refers to
};

/// A btBoxShape or another shape that claims the number of a type which Bullet has no class for is in it,
/// too.
const std::vector<std::string>& bulletShapes();
/// Types without a surface.
const std::vector<std::string>& emptyShapes();

BulletShape makeBulletShape(const std::string& name);

}  // namespace innersphere::test
