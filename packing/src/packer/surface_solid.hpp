// Makes the solid again that a packing was made of.
#pragma once

#include <memory>

#include "innersphere/packing.hpp"
#include "innersphere/solid.hpp"

namespace innersphere {

/// Returns the solid that the packing's own surface bounds: triangles, and in single precision. Throws Error
/// empty_input if it has none, and what makeSolid() throws.
std::unique_ptr<Solid> solidOf(const Packing& packing);

}  // namespace innersphere
