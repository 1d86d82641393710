// Two cubes of 1 m, an edge of the one across an edge of the other, and the shortest way out of each other.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <LinearMath/btTransform.h>

#include "innersphere/contact_options.hpp"
#include "innersphere/packing_shape.hpp"

namespace innersphere::test {

/// A cube of 1 m: spheres on a grid, the same with edges in four pieces, or packed as many as `kind` says.
std::shared_ptr<PackingShape> makeCube(const std::string& kind);

/// How the lowest edge of a cube crosses the highest of another, both about level.
struct Crossing {
  double depth;                     ///< [m]
  double angle;                     ///< between the edges [rad]
  double lean_upper, lean_lower;    ///< of the diagonals that stand on the edges [rad]
  double along_upper, along_lower;  ///< from the middles of the edges [m]
};

struct Cubes {
  btTransform upper, lower;
};

/// The upper cube's edge lies along x.
Cubes place(const Crossing& crossing);

/// The shortest way that takes the upper cube out of the lower one, by the theorem of separating axes.
struct Escape {
  double depth = 1e9;  ///< [m], negative if the cubes are apart
  double next = 1e9;   ///< along the second best axis
  bool between_edges = false;
  std::array<double, 3> direction{};  ///< unit
};

Escape leastEscape(const Cubes& cubes);

/// Angles, depths to a quarter of the size, and places along the edges.
std::vector<Crossing> crossings();
std::string describe(const Crossing& crossing);

/// Expects that cubes of these shapes push each other along the least way out, as deep as that is, for all
/// crossings() in which it lies between edges and is the least by far. Returns how many were tried.
int expectLeastPushes(const std::shared_ptr<btCollisionShape>& upper,
                      const std::shared_ptr<btCollisionShape>& lower, double deepest);

/// Expects that cubes of twice the size, whose margins add up to this [m], are as deep in each other.
void expectDepthsOfTwiceTheSize(const std::shared_ptr<btCollisionShape>& upper,
                                const std::shared_ptr<btCollisionShape>& lower, double margins);

/// Expects that an edge carries a cube that is guided downwards, without sinking in.
void expectGuidedCubeIsCarried(const std::shared_ptr<btCollisionShape>& upper,
                               const std::shared_ptr<btCollisionShape>& lower);

/// Options of contacts that have their true depths.
ContactOptions rigidContacts();

}  // namespace innersphere::test
