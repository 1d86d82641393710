// A device that this process cannot use any more.
#pragma once

namespace innersphere::test {

/// By a kernel that traps: all later calls of this process fail.
void loseDevice();

}  // namespace innersphere::test
