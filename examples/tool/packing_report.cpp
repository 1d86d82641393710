#include "packing_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "innersphere/packing_file.hpp"

namespace innersphere::tool {
namespace {

double diagonalOf(const Surface& surface) {
  if (surface.vertices.empty()) return 0;
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax_element(surface.vertices.begin(), surface.vertices.end(),
                                                 [k](const auto& a, const auto& b) { return a[k] < b[k]; });
    squared += std::pow(double{(*high)[k]} - (*low)[k], 2);
  }
  return std::sqrt(squared);
}

// There is no cheap bound on what lies between the points.
constexpr const char* kSampled = " (the largest at 50,000 points)";

// The last six prefixes: shorter ones are for programs.
constexpr std::size_t kPrefixesShown = 6;

// For which depths errors are shown, relative to the cube root of the volume.
constexpr std::array kDepthsShown{0.003, 0.006, 0.01, 0.02, 0.03, 0.06, 0.1, 0.2, 0.3};

template <typename NumberAt>
std::string percentages(const NumberAt& numberAt) {
  std::string text;
  for (double depth : kDepthsShown) {
    char cell[32];
    std::snprintf(cell, sizeof cell, "%9.3g", 100 * numberAt(depth));
    text += cell;
  }
  return text + " %";
}

void addOverlapErrors(const OverlapErrors& errors, Report& report) {
  if (errors.prefixes.empty()) return;
  report.addLine("error of overlaps, deep by",
                 percentages([](double depth) { return depth; }) + " of the cube root of the volume");
  const std::size_t all = errors.prefixes.size();
  for (std::size_t i = all - std::min(all, kPrefixesShown); i < all; ++i) {
    const OverlapErrors::Prefix& prefix = errors.prefixes[i];
    const std::string count = "  " + std::to_string(prefix.count);
    report.addLine(count + ", plain",
                   percentages([&](double depth) { return expectedError(prefix.raw, depth).mean; }));
    report.addLine(count + ", volume-true",
                   percentages([&](double depth) { return expectedError(prefix.volume_true, depth).mean; }));
    report.addLine("    95 % of them below",
                   percentages([&](double depth) { return expectedError(prefix.volume_true, depth).bound; }));
  }
  char text[80];
  std::snprintf(text, sizeof text, "from %g %% of the volume on", 100 * errors.shallowest);
  report.addLine("  measured", text);
}

void addCoverage(const Packing& packing, double diagonal, Report& report) {
  report.add("order", "order", packing.order == SphereOrder::coverage ? "coverage" : "radius");
  if (packing.coverage.empty() || !(diagonal > 0)) return;
  report.addLine("coverage by spheres",
                 "  mean gap   95 %    max, % of the diagonal; without a sphere within 1 %");
  const std::size_t all = packing.coverage.size();
  for (std::size_t i = all - std::min(all, kPrefixesShown); i < all; ++i) {
    const Coverage& c = packing.coverage[i];
    char line[96];
    std::snprintf(line, sizeof line, "%10.2f %6.2f %6.2f;  %.2f %% of the surface", 100 * c.mean / diagonal,
                  100 * c.p95 / diagonal, 100 * c.max / diagonal, 100 * c.uncovered);
    report.addLine("  " + std::to_string(c.count), line);
  }
}

// Adds the range of the spheres' densities, or that there are none.
void addMassWeights(const std::vector<float>& weights, Report& report) {
  if (weights.empty()) {
    report.add("mass_weights", "mass weights", nullptr, "none");
    return;
  }
  const auto [low, high] = std::minmax_element(weights.begin(), weights.end());
  report.add("mass_weights", "mass weights", {{"min", *low}, {"max", *high}},
             number(*low) + " to " + number(*high) + " times the density of the solid");
}

}  // namespace

Report describe(const Packing& packing) {
  const Quality& quality = packing.quality;
  const MassProperties& solid = packing.solid;
  Report report;
  report.add("source", "source", packing.provenance.source);
  report.add("source_hash", "source hash", packing.provenance.source_hash);
  report.add("options", "options", packing.provenance.options);
  report.add("version", packing.provenance.version.empty() ? "" : "written by", packing.provenance.version,
             "InnerSphere " + packing.provenance.version);
  report.add("spheres", "spheres", packing.spheres.size());
  const auto [least, most] =
      std::minmax_element(packing.spheres.begin(), packing.spheres.end(),
                          [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
  const double largest = most->radius, smallest = least->radius;
  report.add("largest_radius", "largest radius", largest, number(largest, "m"));
  report.add("smallest_radius", "smallest radius", smallest, number(smallest, "m"));
  // An import says nothing of its solid: mass properties are those of its spheres.
  const bool measured = quality.density > 0;
  report.add("density", "density", quality.density, measured ? percent(quality.density) : "not known");
  const double diagonal = diagonalOf(packing.surface);
  const auto gap = [&](double length) {
    if (!measured) return std::string("not known");
    return number(length, "m") + (diagonal > 0 ? ", " + percent(length / diagonal) + " of the diagonal" : "");
  };
  report.add("diagonal", diagonal > 0 ? "diagonal" : "", diagonal, number(diagonal, "m"));
  report.add("gap_mean", "surface gap, mean", quality.gap_mean, gap(quality.gap_mean));
  report.add("gap_p95", "surface gap, p95", quality.gap_p95, gap(quality.gap_p95));
  report.add("gap_max", "surface gap, max", quality.gap_max,
             gap(quality.gap_max) + (measured ? kSampled : ""));
  addCoverage(packing, diagonal, report);
  const Certificate& certificate = packing.certificate;
  report.add("delta", "certified greedy", certificate.delta,
             certificate.delta > 0
                 ? "each radius at least 1/" + number(1 + certificate.delta) + " of the largest possible"
                 : "no");
  report.add("largest_missing_radius", certificate.delta > 0 ? "no room for" : "",
             certificate.largest_missing_radius,
             "radii above " + number(certificate.largest_missing_radius, "m"));
  nlohmann::ordered_json prefixes = nlohmann::ordered_json::array();
  std::string prefix_text;
  for (const VolumeTrueRadii& radii : packing.volume_true) {
    prefixes.push_back({{"count", radii.count}, {"sampling_error", radii.sampling_error}});
    if (!prefix_text.empty()) prefix_text += ' ';
    prefix_text += std::to_string(radii.count);
  }
  report.add("volume_true", "volume-true prefixes", prefixes, prefix_text.empty() ? "none" : prefix_text);
  addOverlapErrors(packing.overlap_errors, report);
  // Programs get these as the file has them.
  const auto file = nlohmann::ordered_json::from_cbor(encodePacking(packing));
  for (const char* measured : {"coverage", "errors_by_depth"})
    report.add(measured, "", file.at(measured), "");
  addMassWeights(packing.mass_weights, report);
  report.add("volume", measured ? "volume of the solid" : "volume of the spheres", solid.volume,
             number(solid.volume, "m^3"));
  Vec3d centre = solid.centre_of_mass;
  for (int k = 0; k < 3; ++k) centre[k] += packing.origin[k];
  const double size = diagonal > 0 ? diagonal : std::cbrt(solid.volume);
  report.add("centre_of_mass", measured ? "centre of mass" : "centre of the spheres", centre,
             place(centre, size));
  report.add("origin", packing.origin == Vec3d{} ? "" : "origin of the spheres", packing.origin,
             place(packing.origin, size));
  report.add("inertia", measured ? "inertia, unit density" : "inertia of the spheres", solid.inertia,
             vector({solid.inertia[0], solid.inertia[4], solid.inertia[8]}, "m^5 (xx yy zz)"));
  report.add("triangles", "triangles", packing.surface.triangles.size());
  report.add("warnings", "", packing.warnings, "");
  for (const std::string& warning : packing.warnings) report.addLine("WARNING", warning);
  return report;
}

Report describe(const Covering& covering, double diagonal) {
  Report report;
  const Provenance& from = covering.provenance;
  const bool clump = covering.kind == CoveringKind::clump;
  report.add("kind", "kind",
             clump ? "clump: the union of the spheres is near to the solid; they overlap each other"
                   : "covering: the spheres contain the solid and overlap each other");
  report.add("source", "source", from.source);
  report.add("options", "options", from.options);
  report.add("spheres", "spheres", covering.spheres.size());
  const auto addLength = [&](const std::string& key, const std::string& label, double length,
                             const std::string& how = "") {
    report.add(key, label, length,
               number(length, "m") +
                   (diagonal > 0 ? ", " + percent(length / diagonal) + " of the diagonal" : "") + how);
  };
  report.add("inside", "of the solid inside", covering.inside, percent(covering.inside));
  report.add("outside", "outside of the solid", covering.outside,
             percent(covering.outside) + " of its volume");
  addLength("overhang_mean", "overhang, mean", covering.overhang_mean);
  addLength("overhang_max", "overhang, max", covering.overhang_max);
  addLength("gap_mean", "surface gap, mean", covering.gap_mean);
  addLength("gap_max", "surface gap, max", covering.gap_max, kSampled);
  const MassProperties &solid = covering.solid, &united = covering.united;
  report.add("volume", "volume of the solid", solid.volume, number(solid.volume, "m^3"));
  report.add("union_volume", "volume of the union", united.volume, number(united.volume, "m^3"));
  addLength("union_centre_off", "its centre is off by", norm(united.centre_of_mass - solid.centre_of_mass));
  double off = 0, whole = 0;
  for (std::size_t i = 0; i < solid.inertia.size(); ++i) {
    off += std::pow(united.inertia[i] - solid.inertia[i], 2);
    whole += std::pow(solid.inertia[i], 2);
  }
  const double inertia_off = std::sqrt(off / whole);
  report.add("union_inertia_off", "its inertia is off by", inertia_off, percent(inertia_off));
  addMassWeights(covering.mass_weights, report);
  return report;
}

}  // namespace innersphere::tool
