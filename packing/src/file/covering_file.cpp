#include <nlohmann/json.hpp>

#include "file/file_io.hpp"
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

}  // namespace

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
