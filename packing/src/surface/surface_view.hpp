// Declares a surface as it is seen in the frame of the columns.
#pragma once

#include <vector>

#include "common/mat3.hpp"
#include "surface/box.hpp"
#include "surface/column_pair.hpp"
#include "surface/surface_tree.hpp"

namespace innersphere {

/// Says which surface it is, and where: x = matrix * x_of_the_surface + translation.
struct PlacedSurface {
  const SurfaceTree& tree;
  core::Mat3<double> matrix;
  Vec3d translation;
};

/// Turns boxes and triangles into the frame as they are asked for.
class SurfaceView {
 public:
  SurfaceView(const PlacedSurface& surface, const core::Mat3<double>& frame);

  /// Returns a box that holds the surface.
  Bounds bounds() const;

  /// Returns `box` without what is outside of the solid on its six sides.
  Bounds shrunk(const Bounds& box) const;

  /// Returns the triangles that are in `box` in part.
  std::vector<ColumnTriangle> trianglesIn(const Bounds& box) const;

 private:
  using Lanes = SurfaceTree::Lanes;
  struct LaneBoxes {
    Lanes min[3], max[3];
  };

  template <typename Leaf>
  void visit(const Bounds& box, std::uint32_t node, const Leaf& leaf) const;
  LaneBoxes boxes(const SurfaceTree::Node& node) const;
  ColumnTriangle triangle(std::uint32_t index) const;
  Bounds surfaceIn(const Bounds& box) const;
  void gather(std::uint32_t node, const Bounds& box, Bounds& found) const;
  int windingAt(const Vec3d& point) const;
  Vec3d place(const Vec3f& p) const { return matrix_ * Vec3d{p.x, p.y, p.z} + translation_; }

  const SurfaceTree& tree_;
  core::Mat3<double> matrix_, absolute_;
  Vec3d translation_;
};

}  // namespace innersphere
