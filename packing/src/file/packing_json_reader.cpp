#include <algorithm>

#include "file/json_entry.hpp"
#include "file/packing_json.hpp"
#include "file/packing_schema.hpp"
#include "innersphere/error.hpp"

namespace innersphere {
namespace {

using nlohmann::json;

void requireVersion(const JsonEntry& document) {
  const std::string format = document.has("format") ? document["format"].text() : "";
  if (format == kCoveringFormat) {
    throw Error(
        ErrorCode::bad_format,
        "these spheres cover a solid: they overlap each other and reach out of it, so the volumes that they "
        "share mean nothing; this needs a packing, from `innersphere pack` without --cover");
  }
  if (format == kClumpFormat) {
    throw Error(ErrorCode::bad_format,
                "these spheres are a clump: they overlap each other and reach out of their solid, so the "
                "volumes that they share mean nothing; this needs a packing, from `innersphere pack` without "
                "--clump");
  }
  if (format != kPackingFormat) {
    throw Error(ErrorCode::bad_format,
                "this is not a packing file (no format '" + std::string(kPackingFormat) + "')");
  }
  const double version = document["version"].number();
  if (version > kPackingFormatVersion) {
    throw Error(
        ErrorCode::unsupported_version,
        "the packing file has version " + std::to_string(static_cast<long long>(std::min(version, 1e9))) +
            ", this program reads up to " + std::to_string(kPackingFormatVersion) + "; use a newer one");
  }
  if (version != 1 && version != kPackingFormatVersion) damaged("'version' is not a version");
}

SphereOrder orderOf(const JsonEntry& entry) {
  const std::string name = entry.text();
  if (name != "radius" && name != "coverage") damaged("'order' is not one that this version knows");
  return name == "coverage" ? SphereOrder::coverage : SphereOrder::radius;
}

std::vector<Coverage> coverageOf(const JsonEntry& entry) {
  std::vector<Coverage> prefixes;
  for (const JsonEntry& prefix : entry.items()) {
    prefixes.push_back({prefix["count"].index(), prefix["mean"].number(), prefix["p95"].number(),
                        prefix["max"].number(), prefix["farthest"].vector(), prefix["uncovered"].number()});
  }
  return prefixes;
}

/// The first files know nothing of volumes.
std::vector<OverlapErrors::AtDepth> errorsOf(const JsonEntry& entry) {
  std::vector<OverlapErrors::AtDepth> rows;
  for (const JsonEntry& row : entry.items()) {
    OverlapErrors::AtDepth& at = rows.emplace_back();
    at.depth = row["depth"].number();
    at.error = {row["mean"].number(), row["bound"].number()};
    if (!row.has("volume")) continue;
    at.volume = row["volume"].number();
    at.power = row["power"].number();
  }
  return rows;
}

/// Returns the errors of a prefix with one kind of radii. The first files know nothing of planes, nor of
/// copies that lie nearly upon the solid, nor of balls inside it.
OverlapErrors::Estimate estimateOf(const JsonEntry& prefix, const std::string& radii) {
  OverlapErrors::Estimate estimate{errorsOf(prefix[radii]), 0, {}, {}, {}};
  if (prefix.has(radii + "_deep")) estimate.deep = errorsOf(prefix[radii + "_deep"]);
  if (prefix.has(radii + "_inside")) estimate.inside = errorsOf(prefix[radii + "_inside"]);
  if (prefix.has(radii + "_planes")) {
    const JsonEntry planes = prefix[radii + "_planes"];
    estimate.thickest = planes["thicker_than"].number();
    estimate.planes = errorsOf(planes["errors"]);
  }
  return estimate;
}

OverlapErrors overlapErrorsOf(const JsonEntry& entry) {
  OverlapErrors errors;
  errors.poses = entry["poses"].index();
  errors.shallowest = entry["shallowest"].number();
  errors.sampling_error = entry["sampling_error"].number();
  for (const JsonEntry& prefix : entry["prefixes"].items()) {
    errors.prefixes.push_back(
        {prefix["count"].index(), estimateOf(prefix, "raw"), estimateOf(prefix, "volume_true")});
  }
  return errors;
}

Surface surfaceOf(const JsonEntry& entry) {
  Surface surface;
  const std::vector<float> v = entry["vertices"].floats(3);
  for (std::size_t i = 0; i < v.size(); i += 3) surface.vertices.push_back({v[i], v[i + 1], v[i + 2]});
  const std::vector<std::uint32_t> t = entry["triangles"].indices(3);
  for (std::size_t i = 0; i < t.size(); i += 3) surface.triangles.push_back({t[i], t[i + 1], t[i + 2]});
  return surface;
}

Packing packingOf(const JsonEntry& document) {
  requireVersion(document);
  Packing packing;
  const std::vector<float> s = document["spheres"].floats(4);
  for (std::size_t i = 0; i < s.size(); i += 4)
    packing.spheres.push_back({s[i], s[i + 1], s[i + 2], s[i + 3]});
  for (const JsonEntry& prefix : document["volume_true"].items()) {
    VolumeTrueRadii radii;
    radii.radii = prefix["radii"].floats(1);
    radii.count = static_cast<std::uint32_t>(std::min<std::size_t>(radii.radii.size(), UINT32_MAX));
    radii.sampling_error = prefix["sampling_error"].number();
    packing.volume_true.push_back(std::move(radii));
  }
  packing.surface = surfaceOf(document["surface"]);
  // Entries that came later than the first files.
  if (document.has("origin")) packing.origin = document["origin"].vector();
  if (document.has("order")) packing.order = orderOf(document["order"]);
  if (document.has("coverage")) packing.coverage = coverageOf(document["coverage"]);
  if (document.has("errors_by_depth")) packing.overlap_errors = overlapErrorsOf(document["errors_by_depth"]);
  if (document.has("mass_weights")) packing.mass_weights = document["mass_weights"].floats(1);
  if (document.has("warnings")) {
    for (const JsonEntry& warning : document["warnings"].items()) packing.warnings.push_back(warning.text());
  }
  // Means of four bins, 2 to 4 times too small for shallow overlaps; errors relative to the truth; and errors
  // by volume, up to 6 times too small where walls lie along walls.
  if (document.has("overlap_errors") || document.has("expected_errors") || document.has("volume_errors")) {
    packing.warnings.push_back(
        "the file's estimates of errors are of an older kind and are left out; pack the solid again to have "
        "them");
  }

  packing.solid = massPropertiesOf(document["solid"]);
  const JsonEntry certificate = document["certificate"];
  packing.certificate = {certificate["delta"].number(), certificate["largest_missing_radius"].number()};
  const JsonEntry quality = document["quality"];
  packing.quality = {quality["density"].number(), quality["gap_mean"].number(), quality["gap_p95"].number(),
                     quality["gap_max"].number()};
  packing.provenance = provenanceOf(document["provenance"]);
  return packing;
}

}  // namespace

Packing fromJson(const std::string& text) {
  return readJson(text, json::input_format_t::json, packingOf);
}
Packing fromCbor(const std::string& bytes) {
  return readJson(bytes, json::input_format_t::cbor, packingOf);
}

}  // namespace innersphere
