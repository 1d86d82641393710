// A convex polyhedron with its exact distance, by brute force.
#pragma once

#include <array>
#include <vector>

namespace innersphere::test {

/// Shares no code with the plug-in or Bullet.
class Polyhedron {
 public:
  using Vector = std::array<double, 3>;
  /// Of points of which no four lie in one plane: its faces are all triples that have all others behind them.
  explicit Polyhedron(std::vector<Vector> corners);

  struct Near {
    double distance;  ///< [m], negative inside
    Vector normal;    ///< unit, outwards at the nearest point
  };
  Near near(const Vector& place) const;

 private:
  struct Face {
    std::array<int, 3> corners;  ///< counter-clockwise from outside
    Vector normal;
    double offset;
  };
  void addIfOutermost(int i, int j, int k);
  Vector nearestOf(const Vector& p, const Face& face, double height) const;

  std::vector<Vector> corners_;
  std::vector<Face> faces_;
};

}  // namespace innersphere::test
