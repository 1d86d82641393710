// Finds the nearest point of a set of triangles.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "innersphere/mesh.hpp"
#include "innersphere/solid.hpp"
#include "mesh/triangle.hpp"
#include "surface/lanes.hpp"

namespace innersphere {

/// Holds a tree of boxes over the triangles. It looks at a copy of unit diagonal, four boxes or triangles at
/// a time and in float, and serves only to leave out triangles that are certainly too far; distances and the
/// choice among the rest are in double and equal brute force bit for bit (the lowest index wins a tie).
class ClosestTriangle {
 public:
  explicit ClosestTriangle(const Mesh& mesh);

  struct Nearest : ClosestPoint {
    const Triangle* triangle = nullptr;  ///< that the point lies on
  };

  /// Returns the nearest point; beyond `cutoff` [m] the distance is infinity.
  Nearest closest(const Vec3d& p, double cutoff) const;
  /// A ball counts as empty if no triangle reaches into this part of its radius.
  static constexpr double kEmpty = 1 - 1e-6;
  /// Returns the radius [m] of the largest empty ball, from `least` to `most`, that touches the place `at`
  /// and lies on this side of it (unit vector). Returns 0 if there is none.
  double emptyRadius(const Vec3d& at, const Vec3d& side, double least, double most) const;
  /// Returns 1 in front of the triangle, which is the nearest one, and -1 behind it, if the nearest point is
  /// clearly inside of it, or it is `gentle` (as of BesideTriangle), and farther than rounding; else 0.
  int sideOf(const Vec3d& p, const Triangle& nearest, bool gentle) const;
  /// Returns which of the mesh's triangles one is that closest() returned.
  std::uint32_t indexOf(const Triangle& triangle) const { return number_[&triangle - triangles_.data()]; }

 private:
  class Builder;
  class Reach;
  static constexpr std::uint32_t kWidth = 4, kLeaf = 1u << 31;

  struct Node {
    FourFloats low[3]{}, high[3]{};    ///< of the children's boxes
    std::uint32_t children[kWidth]{};  ///< nodes, or leaves with the bit kLeaf
    std::uint32_t count = 0;
  };
  /// The places x with normal . x = offset.
  struct Planes {
    FourFloats normal[3]{}, offset{};
    void set(std::uint32_t lane, const Vec3d& unit_normal, const Vec3d& place);
    FourFloats heights(const FourFloats (&x)[3]) const {
      return normal[0] * x[0] + normal[1] * x[1] + normal[2] * x[2] - offset;
    }
  };
  /// Leaf i has the triangles 4 i to 4 i + 3. Those too thin for a normal have none, and are not left out.
  struct Leaf {
    Planes faces, edges[3];  ///< the latter upright on the former; triangles are in front
  };

  /// Calls look(i) for all triangles i that may be within reach, near ones first. It may lessen the reach, to
  /// a part of what it was; it returns true if that has another centre.
  template <class Look>
  void visitWithin(const Reach& reach, const Look& look) const;

  std::vector<Triangle> triangles_;    ///< in the order of the tree
  std::vector<std::uint32_t> number_;  ///< of each in the mesh
  std::vector<Node> nodes_;            ///< the root is the last one
  std::vector<Leaf> leaves_;
  Vec3d centre_{};
  double to_unit_ = 1;
};

}  // namespace innersphere
