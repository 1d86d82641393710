#include "sphere_sets.hpp"

#include <algorithm>
#include <cmath>

namespace innersphere::test {

std::uint64_t Random::next() {  // splitmix64
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return z ^ z >> 31;
}

double Random::uniform(double lo, double hi) {
  return lo + (hi - lo) * std::ldexp(static_cast<double>(next() >> 11), -53);
}

Vec3d Random::direction() {
  while (true) {
    const Vec3d v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const double n = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (n > 0.01 && n <= 1) return {v[0] / n, v[1] / n, v[2] / n};
  }
}

Mat3d Random::rotation() {
  long double q[4], n = 0;
  do {
    n = 0;
    for (long double& x : q) x = uniform(-1, 1), n += x * x;
  } while (n > 1 || n < 0.01L);
  for (long double& x : q) x /= std::sqrt(n);
  const long double w = q[0], x = q[1], y = q[2], z = q[3];
  const long double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  Mat3d r;
  for (int i = 0; i < 9; ++i) r[i] = static_cast<double>(m[i]);
  return r;
}

namespace {

Sphere sphere(double x, double y, double z, double r) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(r)};
}

bool fits(const Spheres& spheres, const Sphere& s) {
  return std::all_of(spheres.begin(), spheres.end(), [&](const Sphere& o) {
    const double dx = s.x - o.x, dy = s.y - o.y, dz = s.z - o.z, sum = 1.0000001 * (s.radius + o.radius);
    return dx * dx + dy * dy + dz * dz > sum * sum;
  });
}

void sortByRadius(Spheres& spheres) {
  std::stable_sort(spheres.begin(), spheres.end(),
                   [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
}

}  // namespace

Spheres randomSpheres(std::size_t count, double largest, double ratio, std::uint64_t seed) {
  Random random(seed);
  Spheres spheres;
  for (std::size_t i = 0; i < count; ++i) {
    const double r = largest * std::pow(ratio, -static_cast<double>(i) / static_cast<double>(count));
    for (int tries = 0; tries < 200; ++tries) {
      const Vec3d d = random.direction();
      const double at = std::cbrt(random.uniform()) * (1 - r);
      const Sphere s = sphere(at * d[0], at * d[1], at * d[2], r);
      if (!fits(spheres, s)) continue;
      spheres.push_back(s);
      break;
    }
  }
  return spheres;
}

Spheres clusteredSpheres(std::size_t count, std::size_t clusters, std::uint64_t seed) {
  Random random(seed);
  Spheres spheres;
  for (std::size_t c = 0; c < clusters; ++c) {
    const Vec3d d = random.direction();
    for (Sphere s : randomSpheres(count / clusters, 0.3, 30, seed * 100 + c)) {
      constexpr float kSize = 0.1f;
      s = sphere(kSize * s.x + d[0], kSize * s.y + d[1], kSize * s.z + d[2], kSize * s.radius);
      if (fits(spheres, s)) spheres.push_back(s);
    }
  }
  sortByRadius(spheres);
  return spheres;
}

Spheres lattice(int n, double radius) {
  Spheres spheres;
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z)
        spheres.push_back(sphere(2 * x * radius, 2 * y * radius, 2 * z * radius, radius));
    }
  }
  return spheres;
}

Spheres concentricSpheres(std::size_t count) {
  Spheres spheres;
  for (std::size_t i = 0; i < count; ++i)
    spheres.push_back(sphere(0.25, -0.5, 0.125, std::pow(0.8, static_cast<double>(i))));
  return spheres;
}

Spheres dust(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Spheres spheres{sphere(0, 0, 0, 0.5)};
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d d = random.direction();
    const double r = 0.5e-4, at = 0.5 + random.uniform(1.01, 3) * r;
    spheres.push_back(sphere(at * d[0], at * d[1], at * d[2], r));
  }
  sortByRadius(spheres);
  return spheres;
}

Spheres moved(Spheres spheres, const Vec3d& by) {
  for (Sphere& s : spheres) s = sphere(s.x + by[0], s.y + by[1], s.z + by[2], s.radius);
  return spheres;
}

std::shared_ptr<Packing> makePacking(const Spheres& spheres, bool volume_true) {
  auto packing = std::make_shared<Packing>();
  packing->spheres = spheres;
  for (std::size_t count = 16; volume_true; count *= 4) {
    const std::size_t n = std::min(count, spheres.size());
    VolumeTrueRadii radii;
    radii.count = static_cast<std::uint32_t>(n);
    Random random(n);
    for (std::size_t i = 0; i < n; ++i)
      radii.radii.push_back(static_cast<float>(spheres[i].radius * random.uniform(0.98, 1.3)));
    packing->volume_true.push_back(std::move(radii));
    if (n == spheres.size()) break;
  }
  return packing;
}

std::shared_ptr<CollisionModel> makeModel(const Spheres& spheres, bool volume_true) {
  return std::make_shared<CollisionModel>(makePacking(spheres, volume_true));
}

Placement at(const Vec3d& translation) {
  Placement placement;
  placement.translation = translation;
  return placement;
}

Placement randomPlacement(Random& random, double distance, double scale) {
  Placement placement;
  placement.rotation = random.rotation();
  const Vec3d d = random.direction();
  placement.translation = {distance * d[0], distance * d[1], distance * d[2]};
  placement.scale = scale;
  return placement;
}

}  // namespace innersphere::test
