#include "innersphere/packing.hpp"

#include <cmath>
#include <string>

#include "innersphere/error.hpp"

namespace innersphere {

const VolumeTrueRadii* volumeTrueRadii(const Packing& packing, std::size_t count) {
  const VolumeTrueRadii* best = nullptr;
  for (const VolumeTrueRadii& radii : packing.volume_true) {
    if (radii.count <= count && (!best || radii.count > best->count)) best = &radii;
  }
  return best;
}

void validate(const Packing& packing) {
  if (packing.spheres.empty()) throw Error(ErrorCode::empty_input, "the packing has no spheres");
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const Sphere& s = packing.spheres[i];
    const auto where = [i] { return "sphere " + std::to_string(i); };
    if (!std::isfinite(s.x) || !std::isfinite(s.y) || !std::isfinite(s.z) || !std::isfinite(s.radius)) {
      throw Error(ErrorCode::not_finite, where() + " is not finite");
    }
    if (!(s.radius > 0)) throw Error(ErrorCode::bad_argument, where() + " has a radius that is not positive");
    if (i > 0 && s.radius > packing.spheres[i - 1].radius) {
      throw Error(ErrorCode::bad_argument, where() + " is larger than the one before it; spheres must be sorted by falling radius");
    }
  }
  for (const VolumeTrueRadii& radii : packing.volume_true) {
    if (radii.count == 0 || radii.count > packing.spheres.size() || radii.radii.size() != radii.count) {
      throw Error(ErrorCode::bad_argument, "the volume-true radii of prefix " + std::to_string(radii.count) + " have the wrong length");
    }
    for (float r : radii.radii) {
      if (!std::isfinite(r) || !(r > 0)) {
        throw Error(ErrorCode::bad_argument, "a volume-true radius of prefix " + std::to_string(radii.count) + " is not positive and finite");
      }
    }
  }
}

}  // namespace innersphere
