#include <functional>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "solids/analytic_solids.hpp"
#include "solids/named_meshes.hpp"

namespace innersphere {
namespace {

using Maker = std::function<std::unique_ptr<Solid>(const std::string& name)>;

struct NamedSolid {
  std::string name;
  Maker make;
};

Maker fromMesh(Mesh (*generate)()) {
  return [generate](const std::string& name) { return makeSolid(generate(), name); };
}

const std::vector<NamedSolid>& catalogue() {
  static const std::vector<NamedSolid> solids{
      {"ball", [](const std::string& name) { return ballSolid(name, 0.5); }},
      {"box",
       [](const std::string& name) {
         return boxSolid(name, {1, 1, 1});
       }},
      {"cylinder", [](const std::string& name) { return cylinderSolid(name, 0.3, 1); }},
      {"torus", [](const std::string& name) { return torusSolid(name, 0.35, 0.15); }},
      {"link", fromMesh(linkMesh)},
      {"bowl", fromMesh(bowlMesh)},
      {"gear", fromMesh(gearMesh)},
      {"lbracket", fromMesh(lbracketMesh)},
      {"knot", fromMesh(knotMesh)},
      {"nut", fromMesh(nutMesh)},
      {"bolt", fromMesh(boltMesh)},
      {"chazelle", fromMesh(chazelleMesh)},
      {"tray", fromMesh(trayMesh)},
      {"cup", fromMesh(cupMesh)},
      {"pan", fromMesh(panMesh)},
      {"blade", fromMesh(bladeMesh)},
      {"horn", fromMesh(hornMesh)},
  };
  return solids;
}

}  // namespace

std::unique_ptr<Solid> makeNamedSolid(const std::string& name) {
  std::string known;
  for (const NamedSolid& solid : catalogue()) {
    if (solid.name == name) return solid.make(name);
    known += (known.empty() ? "" : ", ") + solid.name;
  }
  throw Error(ErrorCode::bad_argument, "there is no solid named '" + name + "'; choose one of " + known);
}

std::vector<std::string> namedSolids() {
  std::vector<std::string> names;
  for (const NamedSolid& solid : catalogue()) names.push_back(solid.name);
  return names;
}

}  // namespace innersphere
