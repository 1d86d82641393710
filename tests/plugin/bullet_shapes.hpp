// One of every kind of shape that Bullet has.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/CollisionShapes/btSdfCollisionShape.h>
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

/// A field of distances over the cube from -half to half, of `cells` cells along each edge; between their
/// nodes Bullet interpolates with cubic polynomials.
std::shared_ptr<btSdfCollisionShape> makeSdf(double half, int cells,
                                             const std::function<double(const btVector3&)>& distance);

}  // namespace innersphere::test
