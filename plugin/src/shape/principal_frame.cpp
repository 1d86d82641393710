#include "shape/principal_frame.hpp"

#include <cmath>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

MassProperties sumOfSpheres(const std::vector<Sphere>& spheres) {
  MassProperties sum;
  for (const Sphere& s : spheres) {
    const double v = 4.0 / 3.0 * M_PI * double(s.radius) * s.radius * s.radius;
    sum.volume += v;
    sum.centre_of_mass[0] += v * s.x;
    sum.centre_of_mass[1] += v * s.y;
    sum.centre_of_mass[2] += v * s.z;
  }
  for (double& c : sum.centre_of_mass) c /= sum.volume;
  for (const Sphere& s : spheres) {
    const double r2 = double(s.radius) * s.radius;
    const double v = 4.0 / 3.0 * M_PI * r2 * s.radius;
    const Vec3d d = {s.x - sum.centre_of_mass[0], s.y - sum.centre_of_mass[1], s.z - sum.centre_of_mass[2]};
    const double d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        sum.inertia[3 * i + j] += v * ((i == j ? 0.4 * r2 + d2 : 0) - d[i] * d[j]);
      }
    }
  }
  return sum;
}

}  // namespace

PrincipalFrame principalFrame(const Packing& packing) {
  const MassProperties mass = packing.solid.volume > 0 ? packing.solid : sumOfSpheres(packing.spheres);
  btMatrix3x3 tensor;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) tensor[i][j] = btScalar(mass.inertia[3 * i + j] / mass.volume);
  }
  btMatrix3x3 axes = btMatrix3x3::getIdentity();
  const btScalar trace = tensor[0][0] + tensor[1][1] + tensor[2][2];
  const btScalar largest = btMax(btFabs(tensor[0][1]), btMax(btFabs(tensor[0][2]), btFabs(tensor[1][2])));
  if (largest > btScalar(1e-5) * trace) tensor.diagonalize(axes, SIMD_EPSILON, 64);

  PrincipalFrame frame;
  frame.moments.setValue(tensor[0][0], tensor[1][1], tensor[2][2]);
  frame.from_packing.setBasis(axes.transpose());
  frame.from_packing.setOrigin(-(axes.transpose() * toBullet(mass.centre_of_mass)));
  return frame;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
