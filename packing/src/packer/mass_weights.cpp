#include "packer/mass_weights.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace innersphere {
namespace {

using MomentVector = Eigen::Matrix<double, 10, 1>;
using Matrix10 = Eigen::Matrix<double, 10, 10>;

// The least mass of a sphere, relative to the mass of its cell.
constexpr double kLeastMass = 0.01;

// Relative error of the moments at which the search ends, and the one that is good enough.
constexpr double kExact = 1e-12;
constexpr double kAccepted = 1e-7;

/// Moments of unit mass about the solid's centre of mass, in units of its radius of gyration: 1, x, xx, xy.
struct Frame {
  explicit Frame(const MassProperties& mass)
      : origin(mass.centre_of_mass[0], mass.centre_of_mass[1], mass.centre_of_mass[2]) {
    const double trace = mass.inertia[0] + mass.inertia[4] + mass.inertia[8];
    unit = std::sqrt(trace / (2 * mass.volume));
  }

  MomentVector of(const Sphere& s) const {
    const Eigen::Vector3d x = (Eigen::Vector3d(s.x, s.y, s.z) - origin) / unit;
    const double own = double{s.radius} * s.radius / (5 * unit * unit);
    MomentVector m;
    m << 1, x, x.cwiseAbs2().array() + own, x[0] * x[1], x[1] * x[2], x[2] * x[0];
    return m;
  }

  MomentVector of(const MassProperties& mass) const {
    const Mat3d& i = mass.inertia;
    const double half = (i[0] + i[4] + i[8]) / 2, scale = 1 / (mass.volume * unit * unit);
    MomentVector m;
    m << 1, 0, 0, 0, scale * (half - i[0]), scale * (half - i[4]), scale * (half - i[8]), -scale * i[1],
        -scale * i[5], -scale * i[2];
    return m;
  }

  Eigen::Vector3d origin;
  double unit = 1;
};

}  // namespace

// Least change means masses cell_i (1 + a_i . y), a_i the sphere's moments, where that is over the least
// mass. The ten numbers y follow from the ten equations by Newton's method, exact in one step as long as no
// sphere is held at the least mass.
std::vector<float> findMassWeights(const std::vector<Sphere>& spheres,
                                   const std::vector<double>& cell_volumes, const MassProperties& solid) {
  const Frame frame(solid);
  if (!(frame.unit > 0) || !std::isfinite(frame.unit)) return {};
  const MomentVector wanted = frame.of(solid);
  std::vector<MomentVector> moments;
  moments.reserve(spheres.size());
  for (const Sphere& s : spheres) moments.push_back(frame.of(s));

  MomentVector y = MomentVector::Zero();
  const auto missing = [&](const MomentVector& at, Matrix10* slope) {
    MomentVector rest = wanted;
    if (slope) slope->setZero();
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const double cell = cell_volumes[i] / solid.volume, change = 1 + moments[i].dot(at);
      rest -= cell * std::max(kLeastMass, change) * moments[i];
      if (slope && change > kLeastMass) *slope += cell * moments[i] * moments[i].transpose();
    }
    return rest;
  };
  Matrix10 slope;
  for (int step = 0; step < 50; ++step) {
    const MomentVector rest = missing(y, &slope);
    if (rest.norm() < kExact) break;
    Eigen::CompleteOrthogonalDecomposition<Matrix10> solver;
    solver.setThreshold(1e-10);
    const MomentVector change = solver.compute(slope).solve(rest);
    double part = 1;
    while (part > 1e-3 && missing(y + part * change, nullptr).norm() >= rest.norm()) part /= 2;
    if (part <= 1e-3) break;
    y += part * change;
  }
  if (!(missing(y, nullptr).norm() < kAccepted)) return {};

  std::vector<float> weights;
  weights.reserve(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double radius = spheres[i].radius;
    const double ball = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    weights.push_back(
        static_cast<float>(cell_volumes[i] * std::max(kLeastMass, 1 + moments[i].dot(y)) / ball));
  }
  return weights;
}

}  // namespace innersphere
