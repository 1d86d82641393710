// From the sums of a query to what its caller gets.
#pragma once

#include "core/sums.hpp"
#include "innersphere/overlap.hpp"

namespace innersphere {

/// The sums of a query in floating point.
core::Totals toTotals(const core::Sums& sums, const core::Units& units);

/// The overlap that the sums of a query describe.
Overlap toOverlap(const core::Totals& totals);

}  // namespace innersphere
