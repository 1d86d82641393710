// Counts calls of operator new in this program.
#pragma once

#include <cstddef>

namespace innersphere::test {

std::size_t allocations();

}  // namespace innersphere::test
