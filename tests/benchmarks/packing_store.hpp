// Packings that are made once and used for every budget.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>

#include "innersphere/packing.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::benchmarks {

/// Makes the longest packing of a solid when it is first asked for; shorter ones are its beginnings.
class PackingStore {
 public:
  explicit PackingStore(std::size_t spheres) : spheres_(spheres) {}

  /// Solids are told apart by name, box and hash.
  std::shared_ptr<const Packing> of(const Solid& solid);

 private:
  std::size_t spheres_;
  std::map<std::string, std::shared_ptr<const Packing>> packings_;
};

}  // namespace innersphere::benchmarks
