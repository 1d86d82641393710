// Colours that are told apart easily and look well together.
#pragma once

#include <cstddef>

#include "film.hpp"

namespace innersphere::demo {

/// A colour for the n-th kind of thing; repeats after a while.
Colour paletteColour(std::size_t n);

/// A colour for a value from 0 (dark violet) to 1 (yellow).
Colour rampColour(float value);

/// Colours of a shape's spheres by the logarithm of their radius, the largest ones bright.
std::vector<Colour> radiusColours(const std::vector<Sphere>& spheres);

}  // namespace innersphere::demo
