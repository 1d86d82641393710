#include "innersphere/solids.hpp"

#include <cstdio>

#include "solids/analytic_solids.hpp"

namespace innersphere {
namespace {

std::string called(const char* kind, std::initializer_list<double> lengths) {
  std::string name = kind;
  for (double x : lengths) {
    char digits[32];
    std::snprintf(digits, sizeof digits, " %.9g", x);
    name += digits;
  }
  return name;
}

}  // namespace

std::unique_ptr<Solid> makeBall(double radius) {
  return ballSolid(called("ball", {radius}), radius);
}

std::unique_ptr<Solid> makeBox(const Vec3d& size) {
  return boxSolid(called("box", {size[0], size[1], size[2]}), size);
}

std::unique_ptr<Solid> makeTorus(double ring_radius, double tube_radius) {
  return torusSolid(called("torus", {ring_radius, tube_radius}), ring_radius, tube_radius);
}

std::unique_ptr<Solid> makeCylinder(double radius, double height) {
  return cylinderSolid(called("cylinder", {radius, height}), radius, height);
}

}  // namespace innersphere
