// Volume and direction of single overlaps, in every way to collide.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "packing_store.hpp"
#include "trade_rows.hpp"

namespace innersphere::benchmarks {

/// For names of solids or mesh files; see solidFrom(). Each time is the least of `passes`. Progress goes to
/// stderr.
void measureOverlaps(const std::vector<std::string>& sources, std::size_t passes, PackingStore& store,
                     TradeTable& table);

}  // namespace innersphere::benchmarks
