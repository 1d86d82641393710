// Packings for measuring, made from nothing but a seed, in a second or two for 60,000 spheres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "innersphere/packing.hpp"

namespace innersphere::benchmarks {

/// A ball of radius 1 filled by trial: each sphere is the largest about some random points that touches none
/// of the others. Without volume-true radii.
std::shared_ptr<const Packing> greedyBall(std::size_t spheres, std::uint64_t seed);

}  // namespace innersphere::benchmarks
