#include "innersphere/mesh.hpp"

#include <cmath>
#include <iterator>

#include "common/bounds.hpp"
#include "innersphere/error.hpp"
#include "mesh/mesh_clean.hpp"
#include "mesh/mesh_cuts.hpp"
#include "mesh/mesh_holes.hpp"
#include "mesh/mesh_report.hpp"
#include "mesh/mesh_shells.hpp"
#include "mesh/mesh_solid.hpp"
#include "mesh/mesh_topology.hpp"

namespace innersphere {
namespace {

// Ends of open edges this much of the diagonal apart are one point.
constexpr double kWeldTolerance = 1e-7;
// With repair those this far apart, too: as little as closes the mesh.
constexpr double kRepairTolerances[] = {1e-6, 1e-5, 1e-4};
// Longest sides [m] outside of these make the user check the units.
constexpr double kSmall = 0.005;
constexpr double kLarge = 50;
// Steps of single precision at a mesh's place, relative to its diagonal, that spoil it.
constexpr double kCoarse = 1e-5;

// Tries what may close an open mesh, and moves its surface by no more than a tolerance; keeps what helps.
void mendOpenEdges(Mesh& mesh, Topology& topology, bool repair, MeshReport& report) {
  Bounds box = emptyBounds();
  for (const Vec3d& v : mesh.vertices) extend(box, v);
  const double size = diagonal(box);
  const auto keepIfBetter = [&](std::size_t changes, Mesh&& mended, const std::string& note) {
    if (changes == 0) return;
    const Topology after = topologyOf(mended);
    // Edges whose triangles wind against each other are unbalanced still.
    const auto defects = [](const Topology& t) { return std::pair(t.unbalanced.size(), t.open_edges); };
    if (mended.triangles.empty() || defects(after) >= defects(topology)) return;
    mesh = std::move(mended);
    topology = after;
    report.notes.push_back(note);
  };
  const auto weld = [&](double tolerance) {
    std::vector<bool> open(mesh.vertices.size());
    for (const HalfEdge& e : topology.unbalanced) open[e.from] = open[e.to] = true;
    Mesh welded = mesh;
    const std::size_t merged = weldClose(welded, open, tolerance);
    const std::size_t collapsed = dropCollapsed(welded);
    keepIfBetter(merged + collapsed, std::move(welded),
                 counted(merged, "vertex pair") + " closer than " + text(tolerance) +
                     " m merged, because the mesh was open between them, and " +
                     counted(collapsed, "triangle") + " that collapsed removed");
  };
  const auto split = [&](double tolerance) {
    Mesh splitted = mesh;
    const std::size_t edges = splitAtVertices(splitted, topology, tolerance);
    keepIfBetter(edges, std::move(splitted), counted(edges, "edge") + " split at vertices that lie on them");
  };

  weld(kWeldTolerance * size);
  if (topology.unbalanced.empty()) return;
  Mesh without_flat = mesh;
  const std::size_t flat = dropFlat(without_flat);
  keepIfBetter(flat, std::move(without_flat), counted(flat, "triangle") + " without area removed");
  if (topology.unbalanced.empty()) return;
  split(kWeldTolerance * size);
  if (!repair) return;
  for (const double part : kRepairTolerances) {
    if (topology.open_edges == 0) return;
    weld(part * size);
  }
  if (topology.open_edges > 0) split(*std::rbegin(kRepairTolerances) * size);
}

// A triangle that is there twice counts twice. Two with the same corners that face away from each other count
// as nothing, and are as good as a wall; where every triangle has such a twin, the mesh was exported for both
// sides to be seen.
void dropDuplicates(Mesh& mesh, MeshReport& report) {
  report.duplicates = dropRepeated(mesh);
  if (report.duplicates > 0) {
    report.notes.push_back(counted(report.duplicates, "triangle") + " removed that are there more than once");
  }
  Mesh one_sided = mesh;
  const std::size_t twins = dropTwins(one_sided);
  if (2 * twins != mesh.triangles.size()) return;
  orientAlike(one_sided);
  if (!topologyOf(one_sided).unbalanced.empty()) return;
  mesh = std::move(one_sided);
  report.duplicates += twins;
  report.notes.push_back("every triangle had a twin that faces the other way: " + counted(twins, "twin") +
                         " removed");
}

void noteShells(const ShellsReport& shells, MeshReport& report) {
  if (shells.turned > 0) {
    report.inside_out = shells.turned == shells.count;
    report.notes.push_back(report.inside_out
                               ? "the mesh was inside-out (negative volume): all triangles were turned"
                               : counted(shells.turned, "shell") + " of " + std::to_string(shells.count) +
                                     " inside-out: turned");
  }
  if (shells.cavities > 0) {
    report.notes.push_back(counted(shells.cavities, "closed shell") +
                           " inside another and facing inwards: kept as hollow");
  }
  if (shells.removed > 0) {
    report.notes.push_back(
        counted(shells.removed, "closed shell") +
        " inside solid material but facing outwards: removed; if it was meant to be hollow, "
        "turn its triangles");
  }
}

void noteUnits(MeshReport& report) {
  const Vec3d size = report.bounds.max - report.bounds.min;
  const double longest = std::max({size[0], size[1], size[2]});
  if (longest < kSmall || longest > kLarge) {
    report.notes.push_back("the longest side is " + text(longest) +
                           " m; if that is not so, change the scale (0.001 for a file in millimetres)");
  }
}

// Only where all numbers are those of single precision was something lost on the way.
bool isSingle(const Mesh& mesh, double scale) {
  for (const Vec3d& v : mesh.vertices) {
    for (double x : v) {
      if (scale * static_cast<double>(static_cast<float>(x / scale)) != x) return false;
    }
  }
  return true;
}

void notePlace(const Mesh& mesh, double scale, MeshReport& report) {
  double farthest = 0;
  for (int k = 0; k < 3; ++k) {
    farthest = std::max({farthest, std::abs(report.bounds.min[k]), std::abs(report.bounds.max[k])});
  }
  const double size = diagonal(report.bounds), step = farthest * std::numeric_limits<float>::epsilon();
  if (step > kCoarse * size && isSingle(mesh, scale)) {
    report.notes.push_back(
        "the mesh is " + text(farthest / size) +
        " of its sizes away from the origin, and its numbers are those of single "
        "precision, which are " +
        text(step) +
        " m apart there: if they were rounded to it, move the mesh to the origin before it is "
        "exported");
  }
}

void noteCuts(const Cuts& cuts, MeshReport& report) {
  report.cuts = cuts.pairs;
  report.cut_at = cuts.at;
  if (cuts.pairs == 0) return;
  report.notes.push_back(
      counted(cuts.pairs, "pair") + " of triangles cut each other, one near " + text(cuts.at) +
      ": spheres keep away from all of them, also inside; a union in a mesh editor gives a "
      "better fill");
}

void noteSharedPart(double part, MeshReport& report) {
  constexpr double kTold = 1e-4;  // of the volume: samples tell no less
  if (!(part > kTold)) return;
  report.notes.push_back(
      "shells share " + text(std::round(1e4 * part) / 100) +
      " % of the volume: it counts once in volume and mass properties, which a grid then tells to a few "
      "percent, and for each shell in queries by triangles (estimator 'surface'); a union in a mesh editor "
      "makes all of them right");
}

}  // namespace

std::unique_ptr<Solid> makeSolid(Mesh mesh, const std::string& name, const MeshOptions& options,
                                 MeshReport* report_out) {
  MeshReport local;
  MeshReport& report = report_out ? *report_out : local;
  report = {};
  requireTriangles(mesh, name);

  weldEqual(mesh);
  report.degenerate = dropCollapsed(mesh);
  if (mesh.triangles.empty()) {
    throw Error(ErrorCode::empty_input, name + " has only degenerate triangles (" +
                                            std::to_string(report.degenerate) + " with two equal corners)");
  }
  if (report.degenerate > 0) {
    report.notes.push_back(counted(report.degenerate, "triangle") + " with two equal corners removed");
  }
  dropDuplicates(mesh, report);
  Topology topology = topologyOf(mesh);
  if (!topology.unbalanced.empty()) mendOpenEdges(mesh, topology, options.repair, report);
  report.flipped_edges = topology.flipped_edges;
  if (topology.flipped_edges > 0) {
    const std::size_t turned = orientAlike(mesh);
    topology = topologyOf(mesh);
    report.notes.push_back(counted(turned, "triangle") + " turned to wind like the neighbours");
  }
  describe(topology, mesh, report);
  noteUnits(report);
  notePlace(mesh, options.scale, report);
  if (report.non_manifold_edges > 0) {
    report.notes.push_back(counted(report.non_manifold_edges, "edge") + " used by more than two triangles");
  }

  if (!topology.unbalanced.empty()) {
    if (!options.repair) refuse(report, name, *std::rbegin(kRepairTolerances));
    const std::size_t added = closeLoops(mesh, topology);
    report.notes.push_back("repaired: " + counted(report.open_loops, "hole") + " closed with " +
                           counted(added, "triangle") +
                           ", distances there are to the closing triangles; inside is where the winding "
                           "number exceeds 1/2");
    topology = topologyOf(mesh);
  }
  const ShellsReport shells = orderShells(mesh, topology);
  noteShells(shells, report);
  const Cuts cuts = findCuts(mesh);
  noteCuts(cuts, report);
  const bool may_overlap = report.cuts > 0 || shells.boxes_meet || report.non_manifold_edges > 0;

  auto solid = std::make_unique<MeshSolid>(std::move(mesh), name, may_overlap, cuts.touched);
  const double size = diagonal(solid->bounds());
  if (!(solid->massProperties().volume > 1e-12 * size * size * size)) {
    throw Error(ErrorCode::not_a_solid,
                name + " encloses no volume (" + text(solid->massProperties().volume) +
                    " m^3); it is a sheet" +
                    (report.open_edges > 0 ? ", or its triangles do not meet: give it a thickness, or merge "
                                             "its vertices by distance, in a mesh editor"
                                           : ", give it a thickness in a mesh editor"));
  }
  noteSharedPart(solid->sharedPart(), report);
  return solid;
}

}  // namespace innersphere
