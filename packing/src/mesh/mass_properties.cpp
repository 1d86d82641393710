#include "mesh/mass_properties.hpp"

#include <cassert>
#include <cmath>

#include "common/bounds.hpp"

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

void Moments::addBox(const Bounds& box, double density) {
  const Vec3d size = box.max - box.min;
  const Vec3d x = innersphere::centre(box) - origin;
  const double mass = density * size[0] * size[1] * size[2];
  volume += mass;
  first = first + mass * x;
  for (int k = 0; k < 3; ++k) {
    second[k] += mass * (x[k] * x[k] + size[k] * size[k] / 12);
    second[3 + k] += mass * x[k] * x[(k + 1) % 3];
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
  Moments sum;
  sum.origin = centre(boundsOf(mesh));
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

Moments integrate(const Bounds& box, int resolution,
                  const std::function<Probe(const Vec3d& middle, double reach, double side)>& probe) {
  const auto longest = [](const Vec3d& size) { return std::max({size[0], size[1], size[2]}); };
  const double smallest = longest(box.max - box.min) / resolution;
  Moments sum;
  sum.origin = centre(box);
  std::vector<Bounds> open{box};
  while (!open.empty()) {
    const Bounds cell = open.back();
    open.pop_back();
    const Vec3d size = cell.max - cell.min;
    const Vec3d middle = centre(cell);
    const double reach = 0.5 * norm(size);
    const Probe here = probe(middle, reach, longest(size));
    if (here.constant_within >= reach || longest(size) <= smallest) {
      if (here.value != 0) sum.addBox(cell, here.value);
      continue;
    }
    // Only what is still too long is halved, so that flat boxes end in cubes.
    std::vector<Bounds> parts{cell};
    for (int k = 0; k < 3; ++k) {
      if (size[k] <= smallest) continue;
      for (std::size_t i = 0, n = parts.size(); i < n; ++i) {
        parts.push_back(parts[i]);
        parts[i].max[k] = parts.back().min[k] = middle[k];
      }
    }
    open.insert(open.end(), parts.begin(), parts.end());
  }
  return sum;
}

}  // namespace innersphere
