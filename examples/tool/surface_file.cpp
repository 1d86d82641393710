#include "surface_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "file_names.hpp"
#include "innersphere/error.hpp"
#include "outputs.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

// The fewest digits that give the same number back.
void append(std::string& text, double x) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
}

void appendPlace(std::string& text, const char* what, const Vec3d& place) {
  text += what;
  for (const double x : place) append(text += ' ', x);
  text += '\n';
}

std::string toObj(const Mesh& mesh) {
  std::string text;
  for (const Vec3d& v : mesh.vertices) appendPlace(text, "v", v);
  for (const auto& t : mesh.triangles) {
    text += 'f';
    for (const auto vertex : t) text += ' ' + std::to_string(vertex + 1);
    text += '\n';
  }
  return text;
}

// An empty header, the number of triangles, and of each a normal, which readers find themselves where it is
// zero, its corners and two unused bytes; little-endian.
std::string toBinaryStl(const Mesh& mesh) {
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

std::string toTextStl(const Mesh& mesh) {
  std::string text = "solid\n";
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto vertex : triangle) appendPlace(text, "vertex", mesh.vertices[vertex]);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

// Whether single precision moves a vertex by more than 1e-4 of the mesh's size.
bool isTooFarForSinglePrecision(const Mesh& mesh) {
  Vec3d low = mesh.vertices.at(0), high = low;
  double most = 0;
  for (const Vec3d& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], v[k]);
      high[k] = std::max(high[k], v[k]);
      most = std::max(most, std::abs(v[k] - static_cast<float>(v[k])));
    }
  }
  return most > 1e-4 * std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

std::string toStl(const Mesh& mesh) {
  if (!isTooFarForSinglePrecision(mesh)) return toBinaryStl(mesh);
  say("the surface is so far from the origin that binary STL, which has single precision, would bend it: "
      "it is written as text");
  return toTextStl(mesh);
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
