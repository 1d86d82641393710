#include "packing_report.hpp"

namespace innersphere::tool {

Report describe(const Packing& packing) {
  const Quality& quality = packing.quality;
  const MassProperties& solid = packing.solid;
  Report report;
  report.add("source", "source", packing.provenance.source);
  report.add("source_hash", "source hash", packing.provenance.source_hash);
  report.add("options", "options", packing.provenance.options);
  report.add("version", "written by", packing.provenance.version,
             "InnerSphere " + packing.provenance.version);
  report.add("spheres", "spheres", packing.spheres.size());
  const double largest = packing.spheres.front().radius;
  const double smallest = packing.spheres.back().radius;
  report.add("largest_radius", "largest radius", largest, number(largest, "m"));
  report.add("smallest_radius", "smallest radius", smallest, number(smallest, "m"));
  report.add("density", "density", quality.density, percent(quality.density));
  report.add("gap_mean", "surface gap, mean", quality.gap_mean, number(quality.gap_mean, "m"));
  report.add("gap_p95", "surface gap, p95", quality.gap_p95, number(quality.gap_p95, "m"));
  report.add("gap_max", "surface gap, max", quality.gap_max, number(quality.gap_max, "m"));
  const Certificate& certificate = packing.certificate;
  report.add("delta", "certified greedy", certificate.delta,
             certificate.delta > 0
                 ? "each radius at least 1/" + number(1 + certificate.delta) + " of the largest possible"
                 : "no");
  report.add("largest_missing_radius", "no room for", certificate.largest_missing_radius,
             "radii above " + number(certificate.largest_missing_radius, "m"));
  nlohmann::ordered_json prefixes = nlohmann::ordered_json::array();
  std::string prefix_text;
  for (const VolumeTrueRadii& radii : packing.volume_true) {
    prefixes.push_back({{"count", radii.count}, {"sampling_error", radii.sampling_error}});
    if (!prefix_text.empty()) prefix_text += ' ';
    prefix_text += std::to_string(radii.count);
  }
  report.add("volume_true", "volume-true prefixes", prefixes, prefix_text.empty() ? "none" : prefix_text);
  report.add("volume", "volume of the solid", solid.volume, number(solid.volume, "m^3"));
  report.add("centre_of_mass", "centre of mass", solid.centre_of_mass, vector(solid.centre_of_mass, "m"));
  report.add("inertia", "inertia, unit density", solid.inertia,
             vector({solid.inertia[0], solid.inertia[4], solid.inertia[8]}, "m^5 (xx yy zz)"));
  report.add("triangles", "triangles", packing.surface.triangles.size());
  return report;
}

}  // namespace innersphere::tool
