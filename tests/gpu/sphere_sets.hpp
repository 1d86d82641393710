// Sets of spheres for tests, made from nothing but a seed.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "innersphere/collision_model.hpp"
#include "innersphere/placement.hpp"

namespace innersphere::test {

/// Uniform numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 2 + 1) {}
  double uniform(double lo = 0, double hi = 1);
  Mat3d rotation();
  Vec3d direction();

 private:
  std::uint64_t next();
  std::uint64_t state_;
};

using Spheres = std::vector<Sphere>;

/// Spheres in a ball of radius 1 that do not overlap, radii falling from `largest` over `ratio` decades
/// evenly spread in their logarithm. Spheres that find no room in some tries are left out.
Spheres randomSpheres(std::size_t count, double largest, double ratio, std::uint64_t seed);
/// The same in `clusters` small balls.
Spheres clusteredSpheres(std::size_t count, std::size_t clusters, std::uint64_t seed);
/// n^3 equal spheres that touch each other exactly (lengths are powers of two times small integers).
Spheres lattice(int n, double radius);
/// Concentric balls with falling radii: not a packing, but legal input.
Spheres concentricSpheres(std::size_t count);
/// A large ball, and on its surface a dust of spheres 1e4 times smaller.
Spheres dust(std::size_t count, std::uint64_t seed);

Spheres moved(Spheres spheres, const Vec3d& by);

/// A packing with these spheres and, for prefixes of 16, 64, ... and all, volume-true radii up to 30 %
/// larger.
std::shared_ptr<Packing> makePacking(const Spheres& spheres, bool volume_true = false);
std::shared_ptr<CollisionModel> makeModel(const Spheres& spheres, bool volume_true = false);

Placement at(const Vec3d& translation);
Placement randomPlacement(Random& random, double distance, double scale = 1);

}  // namespace innersphere::test
