// A world in which nothing sleeps, and which keeps account of its energy.
#pragma once

#include <limits>

#include "plugin/test_packings.hpp"
#include "plugin/test_world.hpp"

namespace innersphere::test {

class WatchedWorld : public TestWorld {
 public:
  using TestWorld::TestWorld;

  /// Steps the world, and looks at its energy after each step.
  void watch(double seconds, double dt);

  /// Of all bodies, in the field of gravity [J].
  double energy() const;
  /// How far the energy ever came above what it was when watching began [J].
  double gain() const { return gain_; }
  /// Whether every body was at a finite place at a finite speed after every step.
  bool finite() const { return finite_; }

 private:
  double start_ = std::numeric_limits<double>::quiet_NaN();
  double gain_ = 0;
  bool finite_ = true;
};

bool isFinite(const btRigidBody& body);

}  // namespace innersphere::test
