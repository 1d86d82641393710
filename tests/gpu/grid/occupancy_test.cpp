// What is near the spheres of a grid is never said to be far from them.
#include "grid/occupancy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grid/hash_grid.hpp"
#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

bool meets(const core::GridView& grid, const Vec3f& p, double radius) {
  for (std::uint32_t k = 0; k < grid.count; ++k) {
    const Sphere& s = grid.centred[k];
    if (std::hypot(double{s.x} - p.x, double{s.y} - p.y, double{s.z} - p.z) <= s.radius + radius) return true;
  }
  return false;
}

/// Spheres on a circle of radius 1 around z.
Spheres ring(int count, double radius) {
  Spheres spheres;
  for (int i = 0; i < count; ++i) {
    const double angle = 6.283185307179586 * i / count;
    spheres.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0,
                       static_cast<float>(radius)});
  }
  return spheres;
}

TEST(Occupancy, MissesNothing) {
  const Spheres sets[] = {randomSpheres(500, 0.2, 30, 1),
                          clusteredSpheres(400, 4, 2),
                          dust(500, 3),
                          ring(300, 0.01),
                          moved(randomSpheres(300, 0.2, 30, 4), {1e5, 0, -3e4}),
                          {{1, 2, 3, 1e-30f}}};
  Random random(9);
  for (const Spheres& spheres : sets) {
    SCOPED_TRACE(spheres.size());
    const HashGrid grid(spheres);
    const core::GridView& view = grid.view();
    std::size_t near = 0;
    for (int i = 0; i < 3000; ++i) {
      const double radius = view.radius * std::exp(random.uniform(-10, 0.5));
      const auto at = [&](float half) { return static_cast<float>(random.uniform(-1, 1) * (half + radius)); };
      const Vec3f p{at(view.half.x), at(view.half.y), at(view.half.z)};
      const auto r = static_cast<float>(radius);
      if (!core::meetsBounds(view, p, r) || !meets(view, p, radius * 0.999999)) continue;
      EXPECT_TRUE(grid.occupancy().mayMeet(p, r));
      ++near;
    }
    EXPECT_GT(near, 10u);
  }
}

TEST(Occupancy, TheHoleOfARingIsEmpty) {
  const HashGrid grid(ring(1000, 0.003));
  EXPECT_FALSE(grid.occupancy().mayMeet({0, 0, 0}, 0.1f));
  EXPECT_FALSE(grid.occupancy().mayMeet({0.3f, -0.3f, 0}, 0.1f));
  EXPECT_TRUE(grid.occupancy().mayMeet({0.99f, 0, 0}, 0.1f));
  EXPECT_TRUE(grid.occupancy().mayMeet({0, 0, 0}, 1));
}

}  // namespace
}  // namespace innersphere::test
