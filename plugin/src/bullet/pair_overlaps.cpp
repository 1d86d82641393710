#include "innersphere/pair_overlaps.hpp"

#include "bullet/registration.hpp"
#include "innersphere/error.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

std::vector<PairOverlap> pairOverlaps(btCollisionDispatcher* dispatcher) {
  const std::shared_ptr<Registration> registration = Registration::find(dispatcher);
  if (!registration) {
    throw Error(ErrorCode::bad_argument,
                "pairOverlaps needs a dispatcher that PackingCollisionAlgorithm is registered with.");
  }
  return registration->table().overlaps();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
