#include "coverage_film.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <map>
#include <sstream>

#include "film/palette.hpp"
#include "innersphere/error.hpp"

namespace innersphere::tool {
namespace {

using Vertex = std::array<float, 3>;

// Upper ends of the bands, relative to the diagonal; the last band has none.
constexpr std::array<float, 6> kBands{0.0025f, 0.005f, 0.01f, 0.02f, 0.04f, 0.08f};

// Triangles are cut until no edge is longer than this part of the diagonal, so that bands end smoothly.
constexpr float kLongest = 0.012f;

float length(const Vertex& a, const Vertex& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

float diagonalOf(const Surface& surface) {
  Vertex low = surface.vertices.front(), high = low;
  for (const Vertex& v : surface.vertices) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], v[k]);
      high[k] = std::max(high[k], v[k]);
    }
  }
  return length(low, high);
}

/// Halves long edges, in both of their triangles alike, so that no gaps open.
void cut(Surface& surface, float longest) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middleOf = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, added] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(surface.vertices.size()));
    if (added) {
      const Vertex p = surface.vertices[a], q = surface.vertices[b];
      surface.vertices.push_back({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
    }
    return entry->second;
  };
  std::vector<std::array<std::uint32_t, 3>> open = std::move(surface.triangles);
  surface.triangles.clear();
  while (!open.empty()) {
    const auto t = open.back();
    open.pop_back();
    int edge = 0;
    const auto edgeLength = [&](int k) {
      return length(surface.vertices[t[k]], surface.vertices[t[(k + 1) % 3]]);
    };
    for (int k = 1; k < 3; ++k) {
      if (edgeLength(k) > edgeLength(edge)) edge = k;
    }
    if (edgeLength(edge) <= longest) {
      surface.triangles.push_back(t);
      continue;
    }
    const std::uint32_t a = t[edge], b = t[(edge + 1) % 3], c = t[(edge + 2) % 3], m = middleOf(a, b);
    open.push_back({a, m, c});
    open.push_back({m, b, c});
  }
}

std::size_t bandOf(float gap) {
  return static_cast<std::size_t>(std::upper_bound(kBands.begin(), kBands.end(), gap) - kBands.begin());
}

/// The surface in parts, by the distance to the nearest sphere.
std::vector<Surface> bandsOf(const Packing& packing, float diagonal) {
  Surface fine = packing.surface;
  cut(fine, kLongest * diagonal);
  std::vector<Surface> bands(kBands.size() + 1);
  // Neighbours share vertices, also so that they are shaded as one face.
  std::vector<std::map<std::uint32_t, std::uint32_t>> known(bands.size());
  for (const auto& t : fine.triangles) {
    Vertex middle{};
    for (std::uint32_t v : t) {
      for (int k = 0; k < 3; ++k) middle[k] += fine.vertices[v][k] / 3;
    }
    float gap = std::numeric_limits<float>::max();
    for (const Sphere& s : packing.spheres) gap = std::min(gap, length(middle, {s.x, s.y, s.z}) - s.radius);
    const std::size_t index = bandOf(gap / diagonal);
    Surface& band = bands[index];
    auto& triangle = band.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const auto [entry, added] =
          known[index].try_emplace(t[k], static_cast<std::uint32_t>(band.vertices.size()));
      if (added) band.vertices.push_back(fine.vertices[t[k]]);
      triangle[k] = entry->second;
    }
  }
  return bands;
}

/// "0.25%"
std::string percentOf(float part) {
  std::ostringstream text;
  text << std::setprecision(3) << 100 * part << '%';
  return text.str();
}

}  // namespace

std::string addCoverage(const Packing& packing, demo::Film& film) {
  if (packing.surface.triangles.empty()) {
    throw Error(ErrorCode::empty_input, "the packing holds no surface, so there is nothing to colour");
  }
  const std::vector<Surface> bands = bandsOf(packing, diagonalOf(packing.surface));
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const demo::Colour colour = demo::rampColour(1 - static_cast<float>(i) / kBands.size());
    film.scale.push_back({colour, i < kBands.size() ? percentOf(kBands[i]) : ""});
    if (bands[i].triangles.empty()) continue;
    film.actors.push_back({static_cast<std::uint32_t>(film.shapes.size()), colour});
    film.shapes.push_back({"band " + std::to_string(i), bands[i], {}});
  }
  return "Colours show the distance of the surface to the nearest sphere: yellow below 0.25 % of the "
         "diagonal, "
         "then 0.5, 1, 2, 4, 8 %, and dark violet beyond.";
}

}  // namespace innersphere::tool
