// Turns the sums of a query into what its caller gets.
#pragma once

#include "core/sums.hpp"
#include "innersphere/overlap.hpp"

namespace innersphere {

/// Returns the sums of a query in floating point.
core::Totals toTotals(const core::Sums& sums, const core::Units& units);

/// Returns the overlap that the sums of a query describe.
Overlap toOverlap(const core::Totals& totals, const core::PairSetup& setup);

}  // namespace innersphere
