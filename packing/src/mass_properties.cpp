#include "mass_properties.hpp"

#include <cassert>
#include <cmath>

#include "vec3.hpp"

namespace innersphere {

MassProperties Moments::massProperties() const {
  MassProperties mass;
  mass.volume = volume;
  if (!(volume > 0)) return mass;
  const Vec3d c = (1 / volume) * first;
  mass.centre_of_mass = origin + c;
  const double xx = second[0] - volume * c[0] * c[0];
  const double yy = second[1] - volume * c[1] * c[1];
  const double zz = second[2] - volume * c[2] * c[2];
  const double xy = second[3] - volume * c[0] * c[1];
  const double yz = second[4] - volume * c[1] * c[2];
  const double zx = second[5] - volume * c[2] * c[0];
  mass.inertia = {yy + zz, -xy, -zx, -xy, zz + xx, -yz, -zx, -yz, xx + yy};
  return mass;
}

void Moments::addPoint(const Vec3d& p, double weight) {
  const Vec3d x = p - origin;
  volume += weight;
  first = first + weight * x;
  for (int k = 0; k < 3; ++k) {
    second[k] += weight * x[k] * x[k];
    second[3 + k] += weight * x[k] * x[(k + 1) % 3];
  }
}

void Moments::add(const Moments& other) {
  assert(origin == other.origin);
  volume += other.volume;
  first = first + other.first;
  for (int k = 0; k < 6; ++k) second[k] += other.second[k];
}

// Each triangle and the origin span a tetrahedron with corners 0, a, b, c and signed volume det / 6, over
// which the integral of x_i x_j is det / 120 (s_i s_j + a_i a_j + b_i b_j + c_i c_j), s = a + b + c.
Moments momentsOf(const Mesh& mesh) {
  Bounds box = emptyBounds();
  for (const auto& t : mesh.triangles) {
    for (std::uint32_t v : t) extend(box, mesh.vertices[v]);
  }
  Moments sum;
  sum.origin = centre(box);
  for (const auto& t : mesh.triangles) {
    const Vec3d a = mesh.vertices[t[0]] - sum.origin;
    const Vec3d b = mesh.vertices[t[1]] - sum.origin;
    const Vec3d c = mesh.vertices[t[2]] - sum.origin;
    const double det = dot(a, cross(b, c));
    const Vec3d s = a + b + c;
    sum.volume += det / 6;
    sum.first = sum.first + (det / 24) * s;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      sum.second[k] += det / 120 * (s[k] * s[k] + a[k] * a[k] + b[k] * b[k] + c[k] * c[k]);
      sum.second[3 + k] += det / 120 * (s[k] * s[l] + a[k] * a[l] + b[k] * b[l] + c[k] * c[l]);
    }
  }
  return sum;
}

Moments sampledMoments(const Bounds& box, int resolution, const std::function<double(const Vec3d&)>& weight) {
  const Vec3d size = box.max - box.min;
  const double cell = std::max({size[0], size[1], size[2]}) / resolution;
  Vec3d step{};
  std::array<int, 3> count{};
  for (int k = 0; k < 3; ++k) {
    count[k] = std::max(1, static_cast<int>(std::ceil(size[k] / cell - 1e-9)));
    step[k] = size[k] / count[k];
  }
  Moments sum;
  sum.origin = centre(box);
  const double volume = step[0] * step[1] * step[2];
  for (int z = 0; z < count[2]; ++z) {
    for (int y = 0; y < count[1]; ++y) {
      for (int x = 0; x < count[0]; ++x) {
        const Vec3d p = box.min + Vec3d{(x + 0.5) * step[0], (y + 0.5) * step[1], (z + 0.5) * step[2]};
        const double w = weight(p);
        if (w != 0) sum.addPoint(p, w * volume);
      }
    }
  }
  return sum;
}

}  // namespace innersphere
