#include "innersphere/pair_overlaps.hpp"

#include "innersphere/error.hpp"
#include "pair_cache/contact_pair.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

std::vector<PairOverlap> pairOverlaps(btDispatcher* dispatcher) {
  const std::shared_ptr<Registration> registration =
      Registration::find(dynamic_cast<btCollisionDispatcher*>(dispatcher));
  if (!registration) {
    throw Error(ErrorCode::bad_argument,
                "pairOverlaps needs a dispatcher that PackingCollisionAlgorithm is registered with.");
  }
  std::vector<PairOverlap> overlaps;
  PairOverlap overlap;
  registration->pairs().forEach([&](PairContact& pair) {
    if (pair.read(overlap)) overlaps.push_back(overlap);
  });
  return overlaps;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
