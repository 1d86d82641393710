#include "named_packings.hpp"

#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "test_packings.hpp"

namespace innersphere::test {

std::shared_ptr<PackingShape> makeNamedShape(const std::string& name, std::size_t n, double bounding_radius) {
  PackOptions options;
  options.spheres = n;
  auto shape = makeShape(pack(*makeNamedSolid(name), options));
  btVector3 centre;
  btScalar radius;
  shape->getBoundingSphere(centre, radius);
  const btScalar scale = btScalar(bounding_radius) / radius;
  shape->setLocalScaling(btVector3(scale, scale, scale));
  return shape;
}

std::shared_ptr<PackingShape> makeTorusShape(double ring, double tube, std::size_t n) {
  PackOptions options;
  options.spheres = n;
  return makeShape(pack(*makeTorus(ring, tube), options));
}

}  // namespace innersphere::test
