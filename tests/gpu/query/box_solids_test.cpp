// Solids made of boxes and their own copies, moved but not turned: what they share is known from intervals.
// Errors of single overlaps are within their bounds where faces lie flat on faces, where copies lie nearly
// upon each other, and in thin walls around a void.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "conformance.hpp"
#include "innersphere/bounded_query.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"

namespace innersphere::test {
namespace {

/// A box that belongs to a solid, or is cut out of it.
struct Part {
  Vec3d min, max;
  double sign = 1;
};

/// What a solid of these parts shares with its moved copy.
double shared(const std::vector<Part>& parts, const Vec3d& shift) {
  double sum = 0;
  for (const Part& a : parts) {
    for (const Part& b : parts) {
      double volume = a.sign * b.sign;
      for (std::size_t k = 0; k < 3; ++k) {
        const double low = std::max(a.min[k], b.min[k] + shift[k]),
                     high = std::min(a.max[k], b.max[k] + shift[k]);
        volume *= std::max(0.0, high - low);
      }
      sum += volume;
    }
  }
  return sum;
}

/// Errors of single overlaps of a solid with its copy.
class BoxSolid {
 public:
  BoxSolid(std::vector<Part> parts, const Solid& solid, SphereOrder order) : parts_(std::move(parts)) {
    PackOptions options;
    options.spheres = 1000;
    options.order = order;
    const auto packing = std::make_shared<Packing>(pack(solid, options));
    EXPECT_NEAR(shared(parts_, {}), packing->solid.volume, 1e-6 * packing->solid.volume);
    model_ = std::make_shared<CollisionModel>(packing);
    query_.a = query_.b = model_.get();
  }

  /// Looks at the copy moved by this, unless too little is found to say anything.
  void add(const Vec3d& shift) {
    query_.placement_b.translation = shift;
    const Overlap found = context_.overlap(query_, {Want::wrench, Estimator::volume_true});
    if (found.volume < 1e-4 * model_->packing().solid.volume) return;
    const double truth = shared(parts_, shift);
    const double error = std::abs(found.volume - truth) / std::max(found.volume, truth);
    beyond_ += !(error <= expectedError(query_, Estimator::volume_true, found).bound);
    ++poses_;
  }

  /// The part of poses whose error was beyond its bound: 0.05 are expected.
  double beyond() const { return beyond_ / poses_; }
  double poses() const { return poses_; }

 private:
  std::vector<Part> parts_;
  QueryContext context_{{Backend::cpu, 1}};
  std::shared_ptr<CollisionModel> model_;
  PairQuery query_;
  double poses_ = 0, beyond_ = 0;
};

BoxSolid bracket() {
  return {{{{0, 0, 0}, {1, 0.3, 0.3}}, {{0, 0.3, 0}, {0.3, 1, 0.3}}},
          *makeNamedSolid("lbracket"),
          SphereOrder::radius};
}

/// 0.3 x 0.2 x 0.1 outside, around a closed void.
BoxSolid hollowBox(double wall) {
  const Vec3d outside{0.3, 0.2, 0.1}, inside{0.3 - 2 * wall, 0.2 - 2 * wall, 0.1 - 2 * wall};
  Mesh mesh = makeBox(outside)->surface();
  const Mesh hole = makeBox(inside)->surface();
  const auto before = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), hole.vertices.begin(), hole.vertices.end());
  for (const auto& t : hole.triangles)
    mesh.triangles.push_back({before + t[0], before + t[2], before + t[1]});
  return {{{-0.5 * outside, 0.5 * outside}, {-0.5 * inside, 0.5 * inside, -1}},
          *makeSolid(mesh, "hollow box"),
          SphereOrder::coverage};
}

// Of faces that are turned a little some pairs of spheres err one way and some the other. Bounds from such
// poses were exceeded by a quarter of these.
TEST(BoxSolids, ErrWithinTheirBoundsFaceOnFace) {
  BoxSolid solid = bracket();
  Random random(3);
  while (solid.poses() < 300)
    solid.add({random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3),
               0.3 * (1 - std::exp(random.uniform(std::log(1e-4), std::log(0.1))))});
  EXPECT_LE(solid.beyond(), 0.1);
}

// The sum of lenses is more than there is; where it has just come down to that, the error is the largest.
// A quarter of these exceeded bounds from poses of which more and less is shared.
TEST(BoxSolids, ErrWithinTheirBoundsNearlyUponEachOther) {
  BoxSolid solid = bracket();
  Random random(4);
  while (solid.poses() < 300) solid.add(random.uniform(0.011, 0.013) * random.direction());
  EXPECT_LE(solid.beyond(), 0.1);
}

// Copies of thin walls nearly upon each other meet their own spheres, and such lenses are thick. By these
// they passed for a thick body, which errs a twentieth as much; a quarter exceeded that bound.
TEST(BoxSolids, ErrWithinTheirBoundsInThinWalls) {
  constexpr double wall = 0.004;
  BoxSolid solid = hollowBox(wall);
  Random random(5);
  while (solid.poses() < 300) solid.add(random.uniform(0.1, 2) * wall * random.direction());
  EXPECT_LE(solid.beyond(), 0.1);
}

}  // namespace
}  // namespace innersphere::test
