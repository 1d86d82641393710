// Measures a union of balls beside its solid.
#pragma once

#include <span>

#include "innersphere/covering.hpp"
#include "packer/container.hpp"

namespace innersphere {

/// Adds what a covering or clump says of its solid and of the union of its spheres, which are these balls.
/// Runs in the current TBB arena.
void measureUnion(const Container& container, std::span<const Ball> balls, Covering& covering);

}  // namespace innersphere
