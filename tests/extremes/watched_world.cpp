#include "watched_world.hpp"

#include <algorithm>
#include <cmath>

namespace innersphere::test {

void WatchedWorld::watch(double seconds, double dt) {
  for (const auto& body : bodies) {
    if (!body->isStaticObject()) body->setActivationState(DISABLE_DEACTIVATION);
  }
  if (std::isnan(start_)) start_ = energy();
  const long steps = std::lround(seconds / dt);
  for (long i = 0; i < steps; ++i) {
    world.stepSimulation(btScalar(dt), 0);
    gain_ = std::max(gain_, energy() - start_);
    finite_ =
        finite_ && std::all_of(bodies.begin(), bodies.end(), [](const auto& b) { return isFinite(*b); });
  }
}

double WatchedWorld::energy() const {
  double energy = kineticEnergy();
  for (const auto& body : bodies) {
    if (body->isStaticObject()) continue;
    energy -= double(world.getGravity().dot(body->getCenterOfMassPosition())) / double(body->getInvMass());
  }
  return energy;
}

bool isFinite(const btRigidBody& body) {
  const btTransform& t = body.getWorldTransform();
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(t.getBasis()[i].length2())) return false;
  }
  return std::isfinite(t.getOrigin().length2()) && std::isfinite(body.getLinearVelocity().length2()) &&
         std::isfinite(body.getAngularVelocity().length2());
}

}  // namespace innersphere::test
