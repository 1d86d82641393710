// One body of each pair of a block of contacts.
#pragma once

#include <vector>

#include "solver/lanes.hpp"
#include "solver/solver_bodies.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// How far a rotation moves the end of an arm.
inline Lanes3 swing(const Lanes3& axis, Lanes w, const Lanes3& arm) {
  const Lanes3 across = cross(axis, arm);
  return (across * w + cross(axis, across)) * inAll(2);
}

/// Is read from their states, and put back.
struct LaneBodies {
  LaneBodies(const int* places, const std::vector<BodyState>& states) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const BodyState& state = states[static_cast<std::size_t>(places[lane])];
      velocity.set(lane, state.velocity);
      spin.set(lane, state.spin);
      moved.set(lane, state.moved);
      axis.set(lane, btVector3(state.turned.x(), state.turned.y(), state.turned.z()));
      w[lane] = state.turned.w();
      inverse_mass.set(lane, state.inverse_mass);
      xx[lane] = state.xx;
      yy[lane] = state.yy;
      zz[lane] = state.zz;
      xy[lane] = state.xy;
      xz[lane] = state.xz;
      yz[lane] = state.yz;
    }
  }
  void put(const int* places, int movable, std::vector<BodyState>& states) const {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (places[lane] >= movable) continue;
      BodyState& state = states[static_cast<std::size_t>(places[lane])];
      state.velocity = velocity.get(lane);
      state.spin = spin.get(lane);
    }
  }
  Lanes3 velocityAt(const Lanes3& arm) const { return velocity + cross(spin, arm); }
  void push(const Lanes3& impulse) { velocity = velocity + scaled(inverse_mass, impulse); }
  Lanes3 inverseInertiaTimes(const Lanes3& l) const {
    return {xx * l.x + xy * l.y + xz * l.z, xy * l.x + yy * l.y + yz * l.z, xz * l.x + yz * l.y + zz * l.z};
  }
  void turn(const Lanes3& l) { spin = spin + inverseInertiaTimes(l); }
  void pushAt(const Lanes3& arm, const Lanes3& impulse) {
    push(impulse);
    turn(cross(arm, impulse));
  }

  Lanes3 velocity, spin, moved, axis, inverse_mass;
  Lanes w, xx, yy, zz, xy, xz, yz;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
