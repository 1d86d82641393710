// Tells inside from outside by the generalised winding number: 1 inside and 0 outside of a closed mesh, in
// between near the holes of an open one (Jacobson et al. 2013).
#pragma once

#include <vector>

#include "innersphere/mesh.hpp"

namespace innersphere {

/// Returns the solid angle of a triangle as seen from p, over 4 pi; it is positive where p is on its inner
/// side.
double windingNumber(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// This is a tree that lets far triangles count as one dipole (Barill et al. 2018). For a closed mesh the sum
/// is an integer, and the error of the dipoles, under 0.2, is far from changing it.
class WindingTree {
 public:
  explicit WindingTree(const Mesh& mesh);
  /// Returns the winding number of the mesh around p.
  double windingNumber(const Vec3d& p) const;

 private:
  struct Node {
    Vec3d centre{};                    ///< of area
    Vec3d area{};                      ///< sum of the triangles' area vectors
    double far2 = 0;                   ///< squared distance from which the dipole is good enough
    std::uint32_t begin = 0, end = 0;  ///< triangles
    std::uint32_t skip = 0;  ///< next node if this one is done with; the first child follows its parent
  };
  struct Corners {
    Vec3d a, b, c;
  };

  void build(std::uint32_t begin, std::uint32_t end);

  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;  ///< depth first
};

}  // namespace innersphere
