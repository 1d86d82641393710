// Random numbers that are the same everywhere: the standard's distributions are not.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace innersphere::demo {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Evenly between a and b.
  double between(double a, double b) { return a + (b - a) * static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Any order as likely as any other.
  template <typename T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) {
      std::swap(items[i - 1], items[static_cast<std::size_t>(between(0, static_cast<double>(i)))]);
    }
  }

  /// Evenly over all rotations: a point in a shell of four dimensions, normalised.
  btQuaternion rotation() {
    while (true) {
      double q[4];
      double square = 0;
      for (double& x : q) {
        x = between(-1, 1);
        square += x * x;
      }
      if (square < 0.1 || square > 1) continue;
      return btQuaternion(btScalar(q[0]), btScalar(q[1]), btScalar(q[2]), btScalar(q[3])).normalized();
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace innersphere::demo
