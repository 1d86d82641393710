#include <bit>
#include <charconv>
#include <nlohmann/json.hpp>

#include "file/packing_json.hpp"
#include "file/packing_schema.hpp"

namespace innersphere {
namespace {

using nlohmann::json;
using Entries = std::vector<std::pair<std::string, json>>;

enum class Encoding { text, binary };

// The double that prints with the digits that a float needs, where that gives the float back.
double shortest(float x) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, x).ptr;
  double y = x;
  std::from_chars(digits, end, y);
  return static_cast<float>(y) == x ? y : x;
}

json bytesOf(const std::vector<std::uint32_t>& words) {
  json::binary_t::container_type bytes;
  bytes.reserve(4 * words.size());
  for (std::uint32_t word : words) {
    for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * k)));
  }
  return json::binary(std::move(bytes));
}

json floats(const std::vector<float>& numbers, Encoding encoding) {
  if (encoding == Encoding::text) {
    json array = json::array();
    for (float x : numbers) array.push_back(shortest(x));
    return array;
  }
  std::vector<std::uint32_t> words;
  words.reserve(numbers.size());
  for (float x : numbers) words.push_back(std::bit_cast<std::uint32_t>(x));
  return bytesOf(words);
}

json indices(const std::vector<std::uint32_t>& numbers, Encoding encoding) {
  return encoding == Encoding::text ? json(numbers) : bytesOf(numbers);
}

json sphereEntry(const std::vector<Sphere>& spheres, Encoding encoding) {
  std::vector<float> numbers;
  numbers.reserve(4 * spheres.size());
  for (const Sphere& s : spheres) numbers.insert(numbers.end(), {s.x, s.y, s.z, s.radius});
  return floats(numbers, encoding);
}

json volumeTrueEntry(const std::vector<VolumeTrueRadii>& prefixes, Encoding encoding) {
  json array = json::array();
  for (const VolumeTrueRadii& prefix : prefixes) {
    array.push_back({{"radii", floats(prefix.radii, encoding)}, {"sampling_error", prefix.sampling_error}});
  }
  return array;
}

json coverageEntry(const std::vector<Coverage>& prefixes) {
  json array = json::array();
  for (const Coverage& c : prefixes) {
    array.push_back({{"count", c.count},
                     {"mean", c.mean},
                     {"p95", c.p95},
                     {"max", c.max},
                     {"farthest", c.farthest},
                     {"uncovered", c.uncovered}});
  }
  return array;
}

json overlapErrorsEntry(const OverlapErrors& errors) {
  const auto rowsOf = [](const std::vector<OverlapErrors::AtDepth>& errors_by_depth) {
    json rows = json::array();
    for (const OverlapErrors::AtDepth& at : errors_by_depth) {
      rows.push_back({{"depth", at.depth},
                      {"mean", at.error.mean},
                      {"bound", at.error.bound},
                      {"volume", at.volume},
                      {"power", at.power}});
    }
    return rows;
  };
  const auto planesOf = [&](const OverlapErrors::Estimate& estimate) {
    return json{{"thicker_than", estimate.thickest}, {"errors", rowsOf(estimate.planes)}};
  };
  json prefixes = json::array();
  for (const OverlapErrors::Prefix& prefix : errors.prefixes) {
    prefixes.push_back({{"count", prefix.count},
                        {"raw", rowsOf(prefix.raw.copies)},
                        {"volume_true", rowsOf(prefix.volume_true.copies)},
                        {"volume_true_deep", rowsOf(prefix.volume_true.deep)},
                        {"volume_true_inside", rowsOf(prefix.volume_true.inside)},
                        {"raw_planes", planesOf(prefix.raw)},
                        {"volume_true_planes", planesOf(prefix.volume_true)}});
  }
  return {{"poses", errors.poses},
          {"shallowest", errors.shallowest},
          {"sampling_error", errors.sampling_error},
          {"prefixes", std::move(prefixes)}};
}

json surfaceEntry(const Surface& surface, Encoding encoding) {
  std::vector<float> vertices;
  for (const auto& v : surface.vertices) vertices.insert(vertices.end(), v.begin(), v.end());
  std::vector<std::uint32_t> triangles;
  for (const auto& t : surface.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  return {{"vertices", floats(vertices, encoding)}, {"triangles", indices(triangles, encoding)}};
}

Entries entriesOf(const Packing& packing, Encoding encoding) {
  const Provenance& p = packing.provenance;
  const Certificate& c = packing.certificate;
  const Quality& q = packing.quality;
  const MassProperties& m = packing.solid;
  return {
      {"format", kPackingFormat},
      {"version", kPackingFormatVersion},
      {"provenance",
       {{"source", p.source},
        {"source_hash", p.source_hash},
        {"options", p.options},
        {"innersphere_version", p.version}}},
      {"certificate", {{"delta", c.delta}, {"largest_missing_radius", c.largest_missing_radius}}},
      {"quality",
       {{"density", q.density}, {"gap_mean", q.gap_mean}, {"gap_p95", q.gap_p95}, {"gap_max", q.gap_max}}},
      {"coverage", coverageEntry(packing.coverage)},
      {"errors_by_depth", overlapErrorsEntry(packing.overlap_errors)},
      {"warnings", packing.warnings},
      {"solid", {{"volume", m.volume}, {"centre_of_mass", m.centre_of_mass}, {"inertia", m.inertia}}},
      {"origin", packing.origin},
      {"order", packing.order == SphereOrder::coverage ? "coverage" : "radius"},
      {"spheres", sphereEntry(packing.spheres, encoding)},
      {"volume_true", volumeTrueEntry(packing.volume_true, encoding)},
      {"mass_weights", floats(packing.mass_weights, encoding)},
      {"surface", surfaceEntry(packing.surface, encoding)},
  };
}

}  // namespace

std::string toJson(const Packing& packing) {
  std::string text;
  for (const auto& [key, value] : entriesOf(packing, Encoding::text)) {
    text += text.empty() ? "{\n" : ",\n";
    // Paths need not be UTF-8, JSON has to.
    text += json(key).dump() + ": " + value.dump(-1, ' ', false, json::error_handler_t::replace);
  }
  return text + "\n}\n";
}

std::string toCbor(const Packing& packing) {
  json document;
  for (auto& [key, value] : entriesOf(packing, Encoding::binary)) document[key] = std::move(value);
  std::string bytes;
  json::to_cbor(document, bytes);
  return bytes;
}

}  // namespace innersphere
