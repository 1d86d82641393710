// One body of each pair of a block of contacts.
#pragma once

#include <cstddef>
#include <cstring>
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

/// Numbers of bodies that follow each other in their states, each in a Lanes.
template <int kCount>
struct LaneNumbers {
  static_assert(kCount % kLanes == 0);
  Lanes of[kCount] = {};

  LaneNumbers() = default;
  LaneNumbers(const int* places, const std::vector<BodyState>& states, std::size_t first) {
    for (int i = 0; i < kCount; i += kLanes) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const BodyState& state = states[static_cast<std::size_t>(places[lane])];
        std::memcpy(&of[i + lane], reinterpret_cast<const char*>(&state) + bytes(first, i), sizeof(Lanes));
      }
      transpose(of + i);
    }
  }
  /// Bodies that cannot be moved are shared by threads: they are not written.
  void put(const int* places, int movable, std::vector<BodyState>& states, std::size_t first) {
    for (int i = 0; i < kCount; i += kLanes) {
      transpose(of + i);
      for (int lane = 0; lane < kLanes; ++lane) {
        if (places[lane] >= movable) continue;
        BodyState& state = states[static_cast<std::size_t>(places[lane])];
        std::memcpy(reinterpret_cast<char*>(&state) + bytes(first, i), &of[i + lane], sizeof(Lanes));
      }
    }
  }
  Lanes3 vector(int at) const { return {of[at], of[at + 1], of[at + 2]}; }
  void set(int at, const Lanes3& v) {
    of[at] = v.x;
    of[at + 1] = v.y;
    of[at + 2] = v.z;
  }

 private:
  static std::size_t bytes(std::size_t first, int i) {
    return (first + static_cast<std::size_t>(i)) * sizeof(btScalar);
  }
};

/// Is read from their states, and put back.
struct LaneBodies {
  LaneBodies(const int* places, const std::vector<BodyState>& states) {
    const LaneNumbers<8> motion(places, states, kMotion);
    const LaneNumbers<16> pose(places, states, kPose);
    velocity = motion.vector(0);
    spin = motion.vector(4);
    axis = pose.vector(0);
    w = pose.of[3];
    moved = pose.vector(4);
    inverse_mass = pose.vector(7);
    xx = pose.of[10];
    yy = pose.of[11];
    zz = pose.of[12];
    xy = pose.of[13];
    xz = pose.of[14];
    yz = pose.of[15];
  }
  void put(const int* places, int movable, std::vector<BodyState>& states) const {
    LaneNumbers<8> motion;
    motion.set(0, velocity);
    motion.set(4, spin);
    motion.put(places, movable, states, kMotion);
  }
  /// Adds to what the next substep begins with.
  static void add(const Lanes3& impulse, const Lanes3& angular_impulse, const int* places, int movable,
                  std::vector<BodyState>& states) {
    LaneNumbers<8> borne(places, states, kImpulses);
    borne.set(0, borne.vector(0) + impulse);
    borne.set(4, borne.vector(4) + angular_impulse);
    borne.put(places, movable, states, kImpulses);
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

 private:
  /// Where velocities, impulses, and all else begin in a state.
  static constexpr std::size_t kMotion = 0, kImpulses = 8, kPose = 16;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
