#include "packing_store.hpp"

#include <cstdio>
#include <sstream>

#include "innersphere/packer.hpp"

namespace innersphere::benchmarks {

std::shared_ptr<const Packing> PackingStore::of(const Solid& solid) {
  const Bounds box = solid.bounds();
  std::ostringstream key;
  key.precision(17);
  key << solid.name() << ' ' << solid.hash();
  for (int k = 0; k < 3; ++k) key << ' ' << box.min[k] << ' ' << box.max[k];
  std::shared_ptr<const Packing>& packing = packings_[key.str()];
  if (!packing) {
    std::fprintf(stderr, "packing %s ...\n", solid.name().c_str());
    PackOptions options;
    options.spheres = spheres_;
    packing = std::make_shared<const Packing>(pack(solid, options));
  }
  return packing;
}

}  // namespace innersphere::benchmarks
