// Scenes, against what is known of them, in every way to collide.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "packing_store.hpp"
#include "trade_rows.hpp"

namespace innersphere::benchmarks {

struct TradeOptions {
  std::size_t most_spheres = 16384;
  std::size_t passes = 2;           ///< each time is the least of so many runs, unless a run takes long
  std::vector<std::string> scenes;  ///< empty: all
};

/// Names of the scenes that measureScenes() knows.
std::vector<std::string> tradeScenes();

/// Progress goes to stderr.
void measureScenes(const TradeOptions& options, PackingStore& store, TradeTable& table);

}  // namespace innersphere::benchmarks
