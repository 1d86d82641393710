// What the programs of the bench share: the scene file that scene.py prepares, and what they write.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace innersphere::bench {

using Vec3 = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  ///< x y z w

/// A triangle mesh of an OBJ file.
struct Triangles {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Throws std::runtime_error if there is no such file.
Triangles readObj(const std::string& file);

/// A hinge on the world at the centre of mass.
struct Hinge {
  bool there = false;
  Vec3 axis{};        ///< of the world
  double speed = 0;   ///< [rad/s] of its motor
  double torque = 0;  ///< [N m] the most that the motor has; 0: there is none
  double damping = 0; ///< [N m s]
};

/// Values that hold from a time on, or at it: t, x, y, z.
using Schedule = std::vector<std::array<double, 4>>;

/// A body. Its frame is the principal one.
struct Body {
  std::string mesh, packing;       ///< files; empty for boxes
  std::vector<std::string> hulls;  ///< files of convex parts
  Vec3 box{};                      ///< edges [m], if it has no mesh
  double size = 0;                 ///< diagonal of its bounding box [m]
  double mass = 0;                 ///< [kg]; 0: it is fixed or told where to be
  Vec3 inertia{}, position{};
  Quaternion rotation{};
  Hinge hinge;
  Schedule path;   ///< ways from the start [m], straight in between
  Schedule force;  ///< [N], each from its time on

  bool told() const { return !path.empty(); }
  /// How far along its path it is.
  Vec3 wayAt(double time) const;
  Vec3 forceAt(double time) const;
};

struct Scene {
  double seconds = 0, friction = 0;
  bool has_ground = false;
  double ground = 0;
  std::vector<Body> bodies;
};

/// Throws std::runtime_error, or nlohmann::json's exceptions.
Scene readScene(const std::string& file);

struct Pose {
  Vec3 position;
  Quaternion rotation;
};

/// Steps `seconds * rate` times, and writes OUT.f64 and OUT.json. `step` gets the time; `poses` says where all bodies are.
void record(const Scene& scene, int rate, const std::string& out, const std::function<void(double)>& step,
            const std::function<Pose(std::size_t)>& pose);

}  // namespace innersphere::bench
