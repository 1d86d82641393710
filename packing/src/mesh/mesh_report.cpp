#include "mesh/mesh_report.hpp"

#include <cstdio>

#include "common/bounds.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

std::string counted(std::size_t n, const std::string& thing) {
  return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
}

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", x);
  return buffer;
}

std::string text(const Vec3d& p) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, "(%.4g, %.4g, %.4g)", p[0], p[1], p[2]);
  return buffer;
}

void describe(const Topology& topology, const Mesh& mesh, MeshReport& report) {
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  report.open_edges = topology.open_edges;
  report.open_loops = topology.loops;
  report.non_manifold_edges = topology.non_manifold_edges;
  report.components = topology.shells;
  report.bounds = emptyBounds();
  for (const Vec3d& v : mesh.vertices) extend(report.bounds, v);

  std::vector<double> length(topology.loops);
  for (std::size_t i = 0; i < topology.unbalanced.size(); ++i) {
    const HalfEdge& e = topology.unbalanced[i];
    length[topology.loop[i]] += norm(mesh.vertices[e.to] - mesh.vertices[e.from]);
  }
  double longest = -1;
  for (std::size_t i = 0; i < topology.unbalanced.size(); ++i) {
    if (length[topology.loop[i]] <= longest) continue;
    longest = length[topology.loop[i]];
    report.open_at = mesh.vertices[topology.unbalanced[i].from];
  }
}

void requireTriangles(const Mesh& mesh, const std::string& name) {
  if (mesh.triangles.empty()) {
    throw Error(ErrorCode::empty_input, name +
                                            " has no triangles, so there is nothing to fill; "
                                            "check that the export contains the surface");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::uint32_t v : mesh.triangles[i]) {
      if (v >= mesh.vertices.size()) {
        throw Error(ErrorCode::bad_argument, "triangle " + std::to_string(i) + " of " + name +
                                                 " uses vertex " + std::to_string(v) + " of " +
                                                 std::to_string(mesh.vertices.size()));
      }
      if (!isFinite(mesh.vertices[v])) {
        throw Error(ErrorCode::not_finite, "vertex " + std::to_string(v) + " of " + name + " is " +
                                               text(mesh.vertices[v]) +
                                               "; remove it or export the mesh again");
      }
    }
  }
}

void refuse(const MeshReport& report, const std::string& name, double weld) {
  std::string why;
  if (report.open_edges > 0) {
    why = counted(report.open_edges, "open edge") + " in " + counted(report.open_loops, "loop") +
          ", the longest near " + text(report.open_at);
  } else if (report.non_manifold_edges > 0) {
    why = counted(report.non_manifold_edges, "edge") + " with more than two triangles, one near " +
          text(report.open_at);
  } else {
    why = "its triangles cannot be wound alike (it has one side only), see near " + text(report.open_at);
  }
  throw Error(ErrorCode::not_a_solid, name + " does not bound a volume: " + why +
                                          "; close it in a mesh editor, or ask for repair: vertices "
                                          "within " +
                                          text(weld * diagonal(report.bounds)) +
                                          " m are then welded where it is open, holes closed flatly, "
                                          "inside is where the winding number exceeds 1/2, and near a hole "
                                          "the fill is a guess");
}

}  // namespace innersphere
