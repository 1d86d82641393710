// A kernel that stays on the device for the next query: the same bits, whatever comes between two of them.
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "conformance.hpp"
#include "innersphere/error.hpp"

namespace innersphere::test {
namespace {

constexpr double kSeconds = 0.01;

class ResidentConformance : public Conformance {
 protected:
  QueryContext makeResident() const {
    QueryContextOptions options;
    options.backend = GetParam();
    options.resident_seconds = kSeconds;
    return QueryContext(options);
  }

  std::shared_ptr<CollisionModel> a_ = makeModel(randomSpheres(cases(1000, 200), 0.2, 30, 1), true),
                                  b_ = makeModel(randomSpheres(300, 0.3, 20, 2), true);

  /// Places around the body that the other one touches from most of them.
  std::vector<PairQuery> queries(std::size_t count) const {
    Random random(5);
    std::vector<PairQuery> all(count);
    for (PairQuery& query : all) {
      query.a = a_.get();
      query.b = b_.get();
      query.placement_a = randomPlacement(random, 0.5, 1);
      query.placement_b = randomPlacement(random, 1.5, 1);
    }
    return all;
  }
};

TEST_P(ResidentConformance, HasTheBitsOfALaunch) {
  QueryContext launched = makeContext(), resident = makeResident();
  for (const Want want : {Want::touch, Want::volume, Want::wrench}) {
    const std::vector<PairQuery> all = queries(cases(300, 20));
    std::vector<Overlap> expected;  // all of them first: a launch would wait for the kernel that stays
    for (const PairQuery& query : all) expected.push_back(launched.overlap(query, {want, Estimator::raw}));
    std::size_t touching = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_TRUE(sameBits(resident.overlap(all[i], {want, Estimator::raw}), expected[i])) << i;
      touching += expected[i].pair_count > 0;
    }
    EXPECT_GT(touching, 0u);
  }
  EXPECT_EQ(resident.lastBackend(), GetParam());
}

TEST_P(ResidentConformance, IsWhatBruteForceSays) {
  QueryContext resident = makeResident();
  for (const PairQuery& query : queries(cases(30, 6)))
    EXPECT_EQ(differenceInSums(bruteForce(query, Estimator::raw),
                               resident.overlap(query, {Want::wrench, Estimator::raw}), 1e-9),
              "");
}

TEST_P(ResidentConformance, OtherWorkMayComeBetween) {
  QueryContext launched = makeContext(), resident = makeResident(), other = makeResident();
  const std::vector<PairQuery> all = queries(cases(40, 8));
  const auto model = makeModel(randomSpheres(200, 0.3, 20, 3), true);
  QueryResult expected, found;
  for (std::size_t i = 0; i < all.size(); ++i) {
    PairQuery query = all[i];
    switch (i % 8) {
      case 1:  // a batch, with lists
        launched.run(all.data(), all.size(), {Want::contacts, Estimator::volume_true}, expected);
        resident.run(all.data(), all.size(), {Want::contacts, Estimator::volume_true}, found);
        expectSame(found, expected);
        break;
      case 2:  // other models, and the other way round
        query.b = model.get();
        break;
      case 3:
        std::swap(query.a, query.b);
        break;
      case 4:  // it has left meanwhile
        std::this_thread::sleep_for(std::chrono::duration<double>(2 * kSeconds));
        break;
      case 5:  // another one waits for the device
        EXPECT_TRUE(sameBits(other.overlap(query), launched.overlap(query)));
        break;
      case 6: {  // other spheres
        std::vector<Sphere> moved = b_->packing().spheres;
        for (Sphere& s : moved) s.x += 0.01f * static_cast<float>(i);
        b_->update(moved.data(), moved.size());
        break;
      }
      case 7: {  // poses
        const double place[7] = {query.placement_b.translation.x,
                                 query.placement_b.translation.y,
                                 query.placement_b.translation.z,
                                 0,
                                 0,
                                 0,
                                 1};
        Overlap swept;
        resident.sweep(query, {1, nullptr, place, place + 3}, {}, &swept);
        query.placement_b.rotation = Placement().rotation;
        EXPECT_TRUE(sameBits(swept, launched.overlap(query)));
        break;
      }
      default:
        break;
    }
    EXPECT_TRUE(sameBits(resident.overlap(query), launched.overlap(query))) << i;
  }
}

/// A model where another one was in memory is not taken for that.
TEST_P(ResidentConformance, ModelsComeAndGo) {
  QueryContext launched = makeContext(), resident = makeResident();
  PairQuery query = queries(1)[0];
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto model = makeModel(randomSpheres(250, 0.3, 20, seed), true);
    query.b = model.get();
    EXPECT_TRUE(sameBits(resident.overlap(query), launched.overlap(query))) << seed;
  }
}

TEST_P(ResidentConformance, RefusesATimeThatIsNone) {
  for (const double seconds : {-1e-3, 2 * kMostResidentSeconds, std::numeric_limits<double>::quiet_NaN()}) {
    QueryContextOptions options;
    options.backend = GetParam();
    options.resident_seconds = seconds;
    EXPECT_THROW(QueryContext{options}, Error) << seconds;
  }
}

INNERSPHERE_FOR_EACH_BACKEND(ResidentConformance);

}  // namespace
}  // namespace innersphere::test
