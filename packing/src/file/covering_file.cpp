#include <cmath>
#include <nlohmann/json.hpp>

#include "file/file_io.hpp"
#include "file/json_entry.hpp"
#include "file/packing_schema.hpp"
#include "file/packing_text.hpp"
#include "innersphere/covering.hpp"
#include "innersphere/error.hpp"

namespace innersphere {
namespace {

std::string toJson(const Covering& covering) {
  nlohmann::ordered_json spheres = nlohmann::ordered_json::array();
  for (const Sphere& s : covering.spheres) spheres.push_back({s.x, s.y, s.z, s.radius});
  const Provenance& p = covering.provenance;
  const auto entry = [](const MassProperties& m) {
    return nlohmann::ordered_json{
        {"volume", m.volume}, {"centre_of_mass", m.centre_of_mass}, {"inertia", m.inertia}};
  };
  const nlohmann::ordered_json document{
      {"format", covering.kind == CoveringKind::clump ? kClumpFormat : kCoveringFormat},
      {"version", kCoveringFormatVersion},
      {"provenance",
       {{"source", p.source},
        {"source_hash", p.source_hash},
        {"options", p.options},
        {"innersphere_version", p.version}}},
      {"inside", covering.inside},
      {"outside", covering.outside},
      {"overhang_mean", covering.overhang_mean},
      {"overhang_max", covering.overhang_max},
      {"gap_mean", covering.gap_mean},
      {"gap_max", covering.gap_max},
      {"solid", entry(covering.solid)},
      {"union", entry(covering.united)},
      {"mass_weights", covering.mass_weights},
      {"origin", covering.origin},
      {"spheres", spheres},
  };
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::optional<Covering> coveringOf(const JsonEntry& document) {
  const std::string format = document.has("format") ? document["format"].text() : "";
  if (format != kClumpFormat && format != kCoveringFormat) return std::nullopt;
  if (document["version"].number() > kCoveringFormatVersion) {
    throw Error(ErrorCode::unsupported_version,
                "the file is of a later version than this program reads; use a newer one");
  }
  Covering covering;
  covering.kind = format == kClumpFormat ? CoveringKind::clump : CoveringKind::contains;
  covering.origin = document["origin"].vector();
  for (const JsonEntry& entry : document["spheres"].items()) {
    const auto s = entry.numbers<4>();
    const auto at = [&](int k) { return static_cast<float>(s[k]); };
    const Sphere& sphere = covering.spheres.emplace_back(Sphere{at(0), at(1), at(2), at(3)});
    if (!std::isfinite(sphere.x + sphere.y + sphere.z + sphere.radius) || !(sphere.radius > 0))
      damaged("a sphere has no place or radius");
  }
  if (covering.spheres.empty()) damaged("there are no spheres");
  covering.inside = document["inside"].number();
  covering.outside = document["outside"].number();
  covering.overhang_mean = document["overhang_mean"].number();
  covering.overhang_max = document["overhang_max"].number();
  covering.gap_mean = document["gap_mean"].number();
  covering.gap_max = document["gap_max"].number();
  covering.solid = massPropertiesOf(document["solid"]);
  covering.united = massPropertiesOf(document["union"]);
  covering.mass_weights = document["mass_weights"].floats(1);
  if (!covering.mass_weights.empty() && covering.mass_weights.size() != covering.spheres.size())
    damaged("there are not as many masses as spheres");
  covering.provenance = provenanceOf(document["provenance"]);
  return covering;
}

}  // namespace

std::optional<Covering> readCovering(const std::string& path) {
  const std::string bytes = readFile(path);
  try {
    return readJson(bytes, nlohmann::json::input_format_t::json, coveringOf);
  } catch (const Error& error) {
    throw Error(error.code(), path + ": " + error.what());
  }
}

void writeCovering(const Covering& covering, const std::string& path, bool overwrite) {
  const std::string ending = endingOf(path);
  if (ending == "json") return writeFile(path, toJson(covering), overwrite);
  Packing spheres;
  spheres.origin = covering.origin;
  spheres.spheres = covering.spheres;
  if (ending == "ply") return writeFile(path, toPly(spheres), overwrite);
  if (ending == "xyzr") return writeFile(path, toXyzr(spheres), overwrite);
  throw Error(ErrorCode::bad_argument,
              std::string(covering.kind == CoveringKind::clump ? "a clump" : "a covering") +
                  " is written to .json, .ply or .xyzr, not to " + path);
}

}  // namespace innersphere
