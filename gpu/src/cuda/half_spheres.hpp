// Makes the spheres of lists what a traversal tests: in half precision, two by two, so that one instruction
// does two of them. Each is a little larger than its sphere, so that nothing is missed: core::Pair has the
// last word.
//
// Positions are relative to the middle of the list's cell, in its edges. If a query sphere meets a partner,
// |q - p|
// <= r + R, then so do their copies, whose radii grow by what rounding moves the centres. With u = 2^-11,
// what a half rounds by, the square of the copies' distance comes out by up to 5 u too large, and radii and
// their sum by up to 2 u too small, so radii also grow by 5 u; and query spheres by something, as squares of
// halves can be too small for one.
#pragma once

#include <cuda_fp16.h>

#include <cstring>

#include "core/grid_level.hpp"
#include "cuda/batch.hpp"

namespace innersphere::device {

/// Says where a list's spheres are measured from.
struct CellFrame {
  Vec3f middle;  ///< in edges, from the corner of the box around the grid
  float scale;   ///< edges in a metre
};

/// Returns the frame of the cell with these coordinates; number 0 is before the first.
inline __device__ CellFrame frameOf(const core::GridView& grid, int grid_level, const Vec3f& cell) {
  return {cell - Vec3f{0.5f, 0.5f, 0.5f}, core::powerOfTwo(-(grid.finest + grid_level))};
}

/// Returns the frame of the list of all spheres: a cell around them.
inline __device__ CellFrame frameOfAll(const core::GridView& grid) {
  const Vec3f& half = grid.half;
  const float scale = core::powerOfTwo(-core::levelOf(fmaxf(fmaxf(half.x, half.y), half.z)));
  return {scale * half, scale};
}

inline __device__ unsigned bitsOf(__half2 x) {
  unsigned bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}
inline __device__ __half2 halvesOf(unsigned bits) {
  __half2 x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/// Holds a ball as halves.
struct HalfBall {
  __half2 xy, z_radius;
};

constexpr float kHalfGrown = 1 + 5.0f / (1 << 11);
constexpr float kHalfFloor = 1.0f / (1 << 11);  ///< in edges

/// Returns a copy of a ball at `p`, relative to the centre of the grid; its radius is in edges. Squares of
/// halves reach to 65504, so what is beyond `farthest` becomes a ball about the middle that meets all that
/// has to do with the cell.
inline __device__ HalfBall halfBall(const core::GridView& grid, const CellFrame& frame, const Vec3f& p,
                                    float radius, float farthest, float everything) {
  const Vec3f at = frame.scale * (p + grid.half) - frame.middle;
  const bool far = !(fmaxf(fmaxf(fabsf(at.x), fabsf(at.y)), fmaxf(fabsf(at.z), radius)) <= farthest);
  const __half2 xy = __floats2half2_rn(at.x, at.y);
  const float z = __half2float(__float2half_rn(at.z));
  const float moved = fabsf(at.x - __low2float(xy)) + fabsf(at.y - __high2float(xy)) + fabsf(at.z - z);
  if (far) return {__floats2half2_rn(0, 0), __floats2half2_rn(0, everything)};
  return {xy, __floats2half2_rn(z, kHalfGrown * (radius + moved))};
}

/// Returns the copy of a sphere of a list. A query sphere that has to do with its cell is not farther than 60
/// edges from it.
inline __device__ HalfBall partnerBall(const core::GridView& grid, const CellFrame& frame, const Sphere& s) {
  return halfBall(grid, frame, {s.x, s.y, s.z}, frame.scale * s.radius, 128, 120);
}

/// Returns a copy that meets nothing.
inline __device__ HalfBall noBall() {
  const float far = __int_as_float(0x7f800000);
  return {__floats2half2_rn(far, far), __floats2half2_rn(far, 0)};
}

inline __device__ EntryPair pairOf(const HalfBall& a, const HalfBall& b) {
  return {bitsOf(__lows2half2(a.xy, b.xy)), bitsOf(__highs2half2(a.xy, b.xy)),
          bitsOf(__lows2half2(a.z_radius, b.z_radius)), bitsOf(__highs2half2(a.z_radius, b.z_radius))};
}

/// Holds a query sphere's copy.
struct HalfQuerySphere {
  unsigned xy, z_reach;
  unsigned smallest;  ///< of copies that are not too small for it; twice
};

inline __device__ HalfQuerySphere makeHalfQuerySphere(const core::GridView& grid, const CellFrame& frame,
                                                      const core::Lookup& lookup) {
  constexpr float kShrunk =
      kHalfGrown * (1 - 2.0f / (1 << 11));  // both are rounded, and the smallest to a quantum
  const HalfBall ball = halfBall(grid, frame, lookup.p, frame.scale * lookup.reach + kHalfFloor, 60, 100);
  return {bitsOf(ball.xy), bitsOf(ball.z_radius),
          bitsOf(__float2half2_rn(kShrunk * (frame.scale * lookup.smallest) - kHalfFloor / (1 << 12)))};
}

constexpr unsigned kFirstMet = 1u << 15, kSecondMet = 1u << 31;

/// Returns bits for those of two that a query sphere meets.
inline __device__ unsigned met(const HalfQuerySphere& query_sphere, const EntryPair& pair) {
  const __half2 xy = halvesOf(query_sphere.xy), z_reach = halvesOf(query_sphere.z_reach);
  const __half2 dx = __hsub2(halvesOf(pair.x), __low2half2(xy));
  const __half2 dy = __hsub2(halvesOf(pair.y), __high2half2(xy));
  const __half2 dz = __hsub2(halvesOf(pair.z), __low2half2(z_reach));
  const __half2 radius = halvesOf(pair.radius), sum = __hadd2(radius, __high2half2(z_reach));
  const __half2 distance2 = __hfma2(dz, dz, __hfma2(dy, dy, __hmul2(dx, dx)));
  const unsigned nearer = bitsOf(__hfma2(__hneg2(sum), sum, distance2));  // negative
  const unsigned too_small = bitsOf(__hsub2(radius, halvesOf(query_sphere.smallest)));
  return nearer & ~too_small & (kFirstMet | kSecondMet);
}

}  // namespace innersphere::device
