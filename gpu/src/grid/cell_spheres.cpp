#include "grid/cell_spheres.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace innersphere {

void ListedSpheres::build(const Sphere* centred, const std::vector<std::uint32_t>& listed) {
  constexpr std::size_t kGrain = 1 << 15;
  if (capacity_ < listed.size()) {
    capacity_ = listed.size() + listed.size() / 4;
    memory_.reset(new float[4 * capacity_]);
  }
  float* const x = memory_.get();
  float *const y = x + capacity_, *const z = y + capacity_, *const radius = z + capacity_;
  const auto fill = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Sphere& s = centred[listed[k]];
      x[k] = s.x;
      y[k] = s.y;
      z[k] = s.z;
      radius[k] = s.radius;
    }
  };
  if (listed.size() <= kGrain) return fill(0, listed.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, listed.size(), kGrain),
                    [&](const auto& range) { fill(range.begin(), range.end()); });
}

}  // namespace innersphere
