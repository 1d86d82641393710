#include "shape/option_rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "innersphere/error.hpp"
#include "innersphere/packing_shape.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

void require(double value, const char* name, const char* rule) {
  if (std::isfinite(value) && value >= 0) return;
  throw Error(ErrorCode::bad_argument, std::string("ContactOptions::") + name + " is " +
                                           std::to_string(value) + "; it must be " + rule);
}

/// Of a body alone, in a row of springs [N/m^3].
double stiffnessOf(const ContactOptions& options) {
  const bool given = options.response != Response::rigid && options.stiffness > 0;
  return given ? options.stiffness : std::numeric_limits<double>::infinity();
}

Response combine(Response a, Response b) {
  if (a == b || b == Response::rigid) return a;
  if (a == Response::rigid) return b;
  return Response::compliant;
}

const ContactOptions* ownOptions(const btCollisionShape& shape) {
  const PackingShape* packing = PackingShape::from(&shape);
  return packing == nullptr ? nullptr : packing->contactOptions();
}

}  // namespace

ContactOptions combine(const ContactOptions& world, const ContactOptions* a, const ContactOptions* b) {
  ContactOptions pair = a != nullptr ? *a : b != nullptr ? *b : world;
  pair.backend = world.backend;
  pair.estimator = world.estimator;
  pair.reuse = world.reuse;
  if (a == nullptr || b == nullptr) return pair;
  pair.response = combine(a->response, b->response);
  const bool a_is_softer = stiffnessOf(*a) < stiffnessOf(*b);
  const ContactOptions &soft = a_is_softer ? *a : *b, &stiff = a_is_softer ? *b : *a;
  const double softest = stiffnessOf(soft);
  const bool given = std::isfinite(softest);
  const double share = given ? 1 / (1 + softest / stiffnessOf(stiff)) : 0.5;
  pair.stiffness = given ? softest * share : 0;
  pair.damping = share * soft.damping + (1 - share) * stiff.damping;
  pair.accuracy = std::min(a->accuracy, b->accuracy);
  return pair;
}

void checkOptions(const ContactOptions& options) {
  require(options.stiffness, "stiffness", "0 (default) or a positive number of N/m^3.");
  require(options.damping, "damping", "a fraction of critical damping, 0 or more.");
  require(options.accuracy, "accuracy", "0 (all spheres) or a positive number of metres.");
  if (options.estimator == Estimator::surface) {
    throw Error(ErrorCode::bad_argument,
                "ContactOptions::estimator is surface; contacts by volume need spheres: volume_true or raw");
  }
}

ContactOptions optionsOfPair(const ContactOptions& world, const btCollisionShape& a,
                             const btCollisionShape& b) {
  return combine(world, ownOptions(a), ownOptions(b));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
