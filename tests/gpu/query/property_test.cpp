// Laws that hold for any input, with inputs that are searched and shrunk by rapidcheck where it is there, and
// drawn from fixed seeds where it is not.
#include <gtest/gtest.h>

#include <cmath>

#include "conformance.hpp"
#include "laws.hpp"

namespace innersphere::test {
namespace {

/// Two small sets and a pose, from a seed: small enough that a law can be tried hundreds of times.
struct Case {
  Scene scene;
  Random random;
  explicit Case(std::uint64_t seed)
      : scene(makeModel(randomSpheres(3 + seed % 30, 0.5, 1 + static_cast<double>(seed % 7), seed)),
              makeModel(randomSpheres(1 + seed % 17, 0.5, 1 + static_cast<double>(seed % 11), seed + 1))),
        random(seed) {
    scene.query.placement_a = randomPlacement(random, random.uniform(0, 2), random.uniform(0.2, 3));
    scene.query.placement_b = randomPlacement(random, random.uniform(0, 2), random.uniform(0.2, 3));
  }
};

QueryContext& cpu() {
  static QueryContext context({Backend::cpu, 1});
  return context;
}

bool close(double a, double b, double size) {
  return std::fabs(a - b) <= 1e-9 * size;
}

/// Forces turn with the world, and a common shift changes nothing.
bool rigidMotion(std::uint64_t seed) {
  Case c(seed);
  const Overlap before = cpu().overlap(c.scene.query);
  const Mat3d turn = c.random.rotation();
  const auto turned = [&](const Vec3d& v) {
    Vec3d w{};
    for (int i = 0; i < 9; ++i) w[i / 3] += turn[i] * v[i % 3];
    return w;
  };
  for (Placement* p : {&c.scene.query.placement_a, &c.scene.query.placement_b}) {
    const Mat3d old = p->rotation;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        p->rotation[3 * i + j] =
            turn[3 * i] * old[j] + turn[3 * i + 1] * old[3 + j] + turn[3 * i + 2] * old[6 + j];
      }
    }
    p->translation = turned(p->translation);
    for (double& x : p->translation) x += 7;
  }
  const Overlap after = cpu().overlap(c.scene.query);
  const Vec3d force = turned(before.force);
  bool ok =
      close(before.volume, after.volume, before.volume) && close(before.energy, after.energy, before.energy);
  for (int i = 0; i < 3; ++i) ok = ok && close(force[i], after.force[i], before.volume);
  return ok;
}

/// Volumes grow with the cube of a common scale, areas with its square, the energy with its fourth power.
bool scaleLaw(std::uint64_t seed) {
  Case c(seed);
  const Overlap before = cpu().overlap(c.scene.query);
  const double s = std::exp(c.random.uniform(-8, 8));
  for (Placement* p : {&c.scene.query.placement_a, &c.scene.query.placement_b}) {
    p->scale *= s;
    for (double& x : p->translation) x *= s;
  }
  const Overlap after = cpu().overlap(c.scene.query);
  return close(before.volume * s * s * s, after.volume, after.volume) &&
         close(before.stiffness * s * s, after.stiffness, after.stiffness) &&
         close(before.energy * s * s * s * s, after.energy, after.energy);
}

/// A larger margin loses no pair and no volume.
bool marginIsMonotone(std::uint64_t seed) {
  Case c(seed);
  Overlap last;
  for (int step = 0; step < 4; ++step) {
    const Overlap now = cpu().overlap(c.scene.query);
    if (now.pair_count < last.pair_count || now.volume < last.volume || now.energy < last.energy)
      return false;
    last = now;
    c.scene.query.margin += c.random.uniform(0, 0.3);
  }
  return true;
}

bool equalsBruteForce(std::uint64_t seed) {
  Case c(seed);
  c.scene.query.margin = seed % 3 ? 0 : c.random.uniform(0, 1);
  const Oracle oracle = bruteForce(c.scene.query, Estimator::raw);
  QueryResult result;
  cpu().run(&c.scene.query, 1, {Want::pairs, Estimator::raw}, result);
  return differenceInPairs(oracle, result.pairs.items.data(), result.pairs.items.size()).empty() &&
         differenceInSums(oracle, result.overlaps[0], 1e-8).empty();
}

TEST(Property, RigidMotion) {
  checkLaw(rigidMotion);
}
TEST(Property, ScaleLaw) {
  checkLaw(scaleLaw);
}
TEST(Property, MarginIsMonotone) {
  checkLaw(marginIsMonotone);
}
TEST(Property, EqualsBruteForce) {
  checkLaw(equalsBruteForce);
}

}  // namespace
}  // namespace innersphere::test
