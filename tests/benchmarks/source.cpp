#include "source.hpp"

#include <algorithm>
#include <cstdio>

#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/solids.hpp"

namespace innersphere::benchmarks {
namespace {

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// A box around a closed void, of "hollow:LENGTHxWIDTHxHEIGHTxWALL"; null if that is not the name.
std::unique_ptr<Solid> hollowBox(const std::string& name) {
  double x = 0, y = 0, z = 0, wall = 0;
  if (std::sscanf(name.c_str(), "hollow:%lfx%lfx%lfx%lf", &x, &y, &z, &wall) != 4) return nullptr;
  Mesh mesh = makeBox({x, y, z})->surface();
  const Mesh inside = makeBox({x - 2 * wall, y - 2 * wall, z - 2 * wall})->surface();
  const auto before = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), inside.vertices.begin(), inside.vertices.end());
  for (const auto& t : inside.triangles)
    mesh.triangles.push_back({before + t[0], before + t[2], before + t[1]});
  return makeSolid(mesh, name);
}

}  // namespace

std::string plainName(const std::string& source) {
  const std::string file = source.substr(source.find_last_of('/') + 1);  // npos + 1 is 0
  return file.substr(0, file.find_last_of('.'));
}

std::unique_ptr<Solid> solidFrom(const std::string& source) {
  const std::vector<std::string> known = namedSolids();
  if (std::find(known.begin(), known.end(), source) != known.end()) return makeNamedSolid(source);
  if (std::unique_ptr<Solid> hollow = hollowBox(source)) return hollow;
  return makeSolid(readMesh(source), source);
}

std::shared_ptr<const Packing> packingFrom(const std::string& source, std::size_t spheres) {
  if (endsWith(source, ".cbor") || endsWith(source, ".json"))
    return std::make_shared<const Packing>(readPacking(source));
  PackOptions options;
  options.spheres = spheres;
  return std::make_shared<const Packing>(pack(*solidFrom(source), options));
}

Bounds boxOf(const Packing& packing) {
  Bounds box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  const auto include = [&box](const Vec3d& p, double radius) {
    for (int k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], p[k] - radius);
      box.max[k] = std::max(box.max[k], p[k] + radius);
    }
  };
  for (const auto& v : packing.surface.vertices) include({v[0], v[1], v[2]}, 0);
  if (packing.surface.vertices.empty()) {
    for (const Sphere& s : packing.spheres) include({s.x, s.y, s.z}, s.radius);
  }
  return box;
}

}  // namespace innersphere::benchmarks
