#include "solids/sampled_solid.hpp"

#include <algorithm>

#include "common/bounds.hpp"
#include "mesh/mass_properties.hpp"

namespace innersphere {
namespace {

using Node = std::array<int, 3>;

class DistanceGrid {
 public:
  DistanceGrid(const SignedDistance& field, const Bounds& box, int resolution) {
    const Vec3d size = box.max - box.min;
    cell_ = std::max({size[0], size[1], size[2]}) / resolution;
    for (int k = 0; k < 3; ++k) nodes_[k] = static_cast<int>(std::ceil(size[k] / cell_)) + 3;
    origin_ = box.min - Vec3d{cell_, cell_, cell_};
    value_.assign(static_cast<std::size_t>(nodes_[0]) * nodes_[1] * nodes_[2], cell_);
    for (int z = 1; z + 1 < nodes_[2]; ++z) {
      for (int y = 1; y + 1 < nodes_[1]; ++y) fillRow(field, y, z);
    }
  }

  const Node& nodes() const { return nodes_; }
  double cell() const { return cell_; }
  double at(const Node& i) const { return value_[index(i)]; }
  bool inside(const Node& i) const { return at(i) < 0; }
  Vec3d position(const Node& i) const {
    return origin_ +
           cell_ * Vec3d{static_cast<double>(i[0]), static_cast<double>(i[1]), static_cast<double>(i[2])};
  }
  std::size_t index(const Node& i) const {
    return (static_cast<std::size_t>(i[2]) * nodes_[1] + i[1]) * nodes_[0] + i[0];
  }

 private:
  // Nodes well within the distance of another need no query of their own: the surface crosses no edge there.
  void fillRow(const SignedDistance& field, int y, int z) {
    constexpr double kFar = 16, kNear = 2;
    for (int x = 1; x + 1 < nodes_[0];) {
      const double d = field(position({x, y, z}), kFar * cell_);
      value_[index({x, y, z})] = d;
      const int sure = std::min(nodes_[0] - 1, x + static_cast<int>(std::abs(d) / cell_ - kNear));
      for (++x; x < sure; ++x) value_[index({x, y, z})] = std::copysign(kNear * cell_, d);
    }
  }

  Node nodes_{};
  double cell_ = 0;
  Vec3d origin_{};
  std::vector<double> value_;
};

// The mean of the points where the surface crosses the edges of the cell at `low`; false if it crosses none.
bool cellVertex(const DistanceGrid& grid, const Node& low, Vec3d& vertex) {
  Vec3d sum{};
  int crossings = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int edge = 0; edge < 4; ++edge) {
      Node a = low;
      a[(axis + 1) % 3] += edge & 1;
      a[(axis + 2) % 3] += edge >> 1;
      Node b = a;
      ++b[axis];
      if (grid.inside(a) == grid.inside(b)) continue;
      const double t = grid.at(a) / (grid.at(a) - grid.at(b));
      sum = sum + (1 - t) * grid.position(a) + t * grid.position(b);
      ++crossings;
    }
  }
  if (crossings == 0) return false;
  vertex = (1.0 / crossings) * sum;
  return true;
}

}  // namespace

MassProperties sampledMass(const SignedDistance& field, const Bounds& bounds, int resolution) {
  return integrate(bounds, resolution,
                   [&](const Vec3d& p, double reach, double side) {
                     const double d = field(p, reach);
                     return Probe{std::clamp(0.5 - d / side, 0.0, 1.0), std::abs(d)};
                   })
      .massProperties();
}

Mesh sampledSurface(const SignedDistance& field, const Bounds& bounds, int resolution) {
  const DistanceGrid grid(field, bounds, resolution);
  const Node n = grid.nodes();
  Mesh surface;
  std::vector<std::uint32_t> vertex_of(static_cast<std::size_t>(n[0]) * n[1] * n[2]);
  const auto forEachNode = [&](const auto& visit) {
    for (int z = 0; z + 1 < n[2]; ++z) {
      for (int y = 0; y + 1 < n[1]; ++y) {
        for (int x = 0; x + 1 < n[0]; ++x) visit(Node{x, y, z});
      }
    }
  };
  forEachNode([&](const Node& low) {
    Vec3d v;
    if (!cellVertex(grid, low, v)) return;
    vertex_of[grid.index(low)] = static_cast<std::uint32_t>(surface.vertices.size());
    surface.vertices.push_back(v);
  });
  forEachNode([&](const Node& a) {
    for (int axis = 0; axis < 3; ++axis) {
      Node b = a;
      ++b[axis];
      if (grid.inside(a) == grid.inside(b)) continue;
      // The four cells around the edge, counter-clockwise seen from its far end.
      std::array<std::uint32_t, 4> quad;
      for (int i = 0; i < 4; ++i) {
        Node cell = a;
        cell[(axis + 1) % 3] -= i == 0 || i == 3;
        cell[(axis + 2) % 3] -= i == 0 || i == 1;
        quad[i] = vertex_of[grid.index(cell)];
      }
      if (grid.inside(b)) std::swap(quad[1], quad[3]);
      surface.triangles.push_back({quad[0], quad[1], quad[2]});
      surface.triangles.push_back({quad[0], quad[2], quad[3]});
    }
  });
  return surface;
}

}  // namespace innersphere
