// Makes a solid of a triangle mesh.
#pragma once

#include "innersphere/mesh.hpp"
#include "innersphere/solid.hpp"
#include "mesh/beside_triangles.hpp"
#include "mesh/closest_triangle.hpp"
#include "mesh/winding_tree.hpp"

namespace innersphere {

class MeshSolid : public Solid {
 public:
  /// Makes a solid of a closed mesh: each edge is used as often in one direction as in the other. Inside is
  /// where the winding number exceeds 1/2. If it may be other than 0 and 1 somewhere, `count_once` corrects
  /// the mass properties for that by sampling; `touched`: as of Cuts.
  MeshSolid(Mesh closed, const std::string& name, bool count_once, const std::vector<bool>& touched);

  ClosestPoint closestPoint(const Vec3d& p, double cutoff) const override;
  ClosestTriangle::Nearest closestTriangle(const Vec3d& p, double cutoff) const {
    return tree_.closest(p, cutoff);
  }
  double emptyRadius(const Vec3d& at, const Vec3d& side, double least, double most) const {
    return tree_.emptyRadius(at, side, least, most);
  }
  bool contains(const Vec3d& p) const override;
  /// The same where the triangle nearest to p is known.
  bool contains(const Vec3d& p, const Triangle& nearest) const;
  Bounds bounds() const override { return bounds_; }
  MassProperties massProperties() const override { return mass_; }
  /// The part of the volume that shells count more than once, as far as samples tell; 0 without `count_once`.
  double sharedPart() const { return shared_part_; }
  Mesh surface() const override { return mesh_; }
  std::string name() const override { return name_; }
  std::string hash() const override;

 private:
  /// About a whole number. The triangle is the nearest one, or none.
  double windingNumber(const Vec3d& p, const Triangle* nearest) const;

  Mesh mesh_;
  std::string name_;
  Bounds bounds_;
  ClosestTriangle tree_;
  WindingTree winding_;
  std::vector<BesideTriangle> beside_;
  MassProperties mass_;
  double shared_part_ = 0;
};

}  // namespace innersphere
