// Finds the volume that two solids share from the triangles of their surfaces.
#pragma once

#include "surface/column_pair.hpp"
#include "surface/surface_view.hpp"

namespace innersphere {

/// Returns the sums for the volume that A and B share. In the direction z, a point is in A as often as more
/// triangles of A above it face up than down, and in B as often as more of B below it face down than up. So
/// the volume is
///
///   V = - sum over t of A, u of B of s_t s_u integral of max(0, z_t - z_u) dx dy,
///
/// with s = 1 for triangles that face up and -1 for those that face down, over the columns that t and u have
/// in common. That holds for each direction z. Only pairs with t above u count; where `up` leads from A to B
/// and the overlap is shallow, these are the few that meet. Where a surface encloses a part of space twice,
/// that part counts twice.
///
/// All sums are zero if what they leave is no more than rounding. The result has the same bits on every run.
SharedSums sharedVolume(const PlacedSurface& a, const PlacedSurface& b, const Vec3d& up);

}  // namespace innersphere
