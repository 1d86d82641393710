// Declares where two surfaces meet.
#pragma once

#include "surface/grid_surface.hpp"

namespace innersphere {

/// Adds to triangles of A and B the segments in which they meet, and where edges of the one cross the other.
void findMeeting(GridSurface& a, GridSurface& b);

}  // namespace innersphere
