// Where sharp edges of two solids cross.
#pragma once

#include "gauge.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// See Gauge::crossing().
bool crossingEdges(const PackingBody& a, const PackingBody& b, const Gap& gap, const btVector3& direction,
                   Gauge::Corner& crossing);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
