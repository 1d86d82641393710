#include "surface_file.hpp"

#include <cstdint>
#include <cstdio>

#include "file_names.hpp"
#include "innersphere/error.hpp"
#include "outputs.hpp"

namespace innersphere::tool {
namespace {

std::string toObj(const Mesh& mesh) {
  std::string text;
  char line[120];
  for (const Vec3d& v : mesh.vertices) {
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", v[0], v[1], v[2]);
    text += line;
  }
  for (const auto& t : mesh.triangles) {
    std::snprintf(line, sizeof line, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
    text += line;
  }
  return text;
}

// An empty header, the number of triangles, and of each a normal, which readers find themselves where it is
// zero, its corners and two unused bytes; little-endian.
std::string toStl(const Mesh& mesh) {
  std::string bytes(80, ' ');
  const auto append = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) append(0.0f);
    for (const auto vertex : triangle) {
      for (const double x : mesh.vertices[vertex]) append(static_cast<float>(x));
    }
    append(std::uint16_t{0});
  }
  return bytes;
}

}  // namespace

bool isSurfaceFile(const std::string& path) {
  return endingOf(path) == ".obj" || endingOf(path) == ".stl";
}

Mesh surfaceOf(const Packing& packing) {
  if (packing.surface.triangles.empty()) {
    throw Error(ErrorCode::empty_input, "the packing holds no surface, only spheres");
  }
  Mesh mesh;
  for (const auto& v : packing.surface.vertices) {
    mesh.vertices.push_back({packing.origin[0] + v[0], packing.origin[1] + v[1], packing.origin[2] + v[2]});
  }
  mesh.triangles.assign(packing.surface.triangles.begin(), packing.surface.triangles.end());
  return mesh;
}

void writeSurface(const Mesh& mesh, const std::string& path, bool force) {
  writeTextOutput(path, force, endingOf(path) == ".obj" ? toObj(mesh) : toStl(mesh));
}

}  // namespace innersphere::tool
