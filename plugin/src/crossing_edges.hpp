// Where sharp edges of two solids cross.
#pragma once

#include "gauge.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// The crossing that is uphill from a gap between two flat faces: of an edge of A with one of B, along the
/// normal to both, where both solids have nothing further out nearby. False if there is none.
bool crossingEdges(const PackingBody& a, const PackingBody& b, const Gap& gap, Gauge::Corner& crossing);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
