// The tables of packing_benchmark; each goes to stdout.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "innersphere/packing.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::benchmarks {

struct Case {
  std::string name;
  std::shared_ptr<const Solid> solid;
};

/// Solid -> (spheres, density).
using Curves = std::map<std::string, std::vector<std::pair<std::size_t, double>>>;

void tableOfDensities(const std::vector<Case>& cases, const std::vector<std::size_t>& counts, Curves& curves);

/// Time for 1/16, 1/8, ... of `most` spheres, and `most`.
void tableOfLinearity(const Case& solid, std::size_t most);

/// The same bytes for 1, 2 and 8 threads and again; the same packing at other scales and places.
void tableOfInvariance(const Case& solid);

/// A fine mesh of a sphere, a thin shell, a box with rounded edges and holes: many equal distances.
void tableOfSlowCases();

void writeCurves(const Curves& curves, const std::string& path);

}  // namespace innersphere::benchmarks
