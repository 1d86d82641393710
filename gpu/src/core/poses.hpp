// Reads poses from arrays, on the CPU and on the device alike.
#pragma once

#include <cstddef>

#include "core/pair_setup.hpp"
#include "innersphere/poses.hpp"

namespace innersphere::core {

/// Returns the matrix of a unit quaternion x y z w. One that is not of unit length gives a matrix that is no
/// rotation.
INNERSPHERE_HD inline Mat3<double> matrixOf(const double* q) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {{w * w + x * x - y * y - z * z, 2 * (x * y - z * w), 2 * (x * z + y * w),  //
           2 * (x * y + z * w), w * w - x * x + y * y - z * z, 2 * (y * z - x * w),  //
           2 * (x * z - y * w), 2 * (y * z + x * w), w * w - x * x - y * y + z * z}};
}

/// Reads a pose as it is, without a check of its rotation. Returns what is wrong with a matrix' last row, or
/// none.
INNERSPHERE_HD inline Fault loadPose(const Poses& poses, std::size_t number, Mat3<double>& rotation,
                                     Vec3d& translation) {
  if (!poses.matrices) {
    rotation = matrixOf(poses.quaternions + 4 * number);
    for (int i = 0; i < 3; ++i) translation[i] = poses.positions[3 * number + i];
    return Fault::none;
  }
  constexpr double kRounding = 1e-6;
  const double* m = poses.matrices + 16 * number;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation.m[3 * i + j] = m[4 * i + j];
    translation[i] = m[4 * i + 3];
  }
  const double off[] = {m[12], m[13], m[14], m[15] - 1};
  for (const double x : off) {
    if (!(fabs(x) <= kRounding)) return fabs(x) < INFINITY ? Fault::last_row : Fault::not_finite;
  }
  return Fault::none;
}

/// Reads a pose, and makes its matrix a rotation.
INNERSPHERE_HD inline Fault readPose(const Poses& poses, std::size_t number, Mat3<double>& rotation,
                                     Vec3d& translation) {
  const Fault fault = loadPose(poses, number, rotation, translation);
  if (fault != Fault::none) return fault;
  bool finite = true;
  for (const double x : rotation.m) finite = finite && fabs(x) < INFINITY;
  for (int i = 0; i < 3; ++i) finite = finite && fabs(translation[i]) < INFINITY;
  return finite ? makeRotation(rotation) : Fault::not_finite;
}

/// Says what is swept: a body that stands still, and one that is brought to each pose.
struct SweptPair {
  Side a;
  Side b;        ///< Its matrix is not read.
  Vec3d origin;  ///< Of A in the world [m].
};

/// Prepares the pair at one pose of B.
INNERSPHERE_HD inline Fault prepareAt(const SweptPair& pair, const Poses& poses, std::size_t number,
                                      PairSetup& setup) {
  Side b = pair.b;
  Vec3d translation;
  setup.clusters[0] = setup.clusters[1] = 0;
  const Fault fault = readPose(poses, number, b.matrix, translation);
  if (fault != Fault::none) return fault;
  b.matrix = scaled(b.matrix, b.scale);
  return makePairSetup(pair.a, b, translation - pair.origin, setup);
}

}  // namespace innersphere::core
