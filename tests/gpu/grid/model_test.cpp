#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <limits>

#include "grid/model_impl.hpp"
#include "innersphere/error.hpp"
#include "innersphere/query.hpp"
#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

TEST(CollisionModel, RejectsWhatIsNoPacking) {
  EXPECT_THROW(CollisionModel(nullptr), Error);
  EXPECT_THROW(CollisionModel(std::make_shared<Packing>()), Error);
  EXPECT_THROW(makeModel({{0, 0, 0, 0}}), Error);
  EXPECT_THROW(makeModel({{0, 0, 0, -1}}), Error);
  EXPECT_THROW(makeModel({{std::numeric_limits<float>::quiet_NaN(), 0, 0, 1}}), Error);
  EXPECT_THROW(makeModel({{0, 3e30f, 0, 1}}), Error);
}

TEST(CollisionModel, BuildsEachGridOnce) {
  const auto model = makeModel(randomSpheres(300, 0.3, 20, 1), true);
  CollisionModel::Impl& impl = model->impl();
  const ModelGrid* all = &impl.grid(0, Estimator::raw);
  EXPECT_EQ(all, &impl.grid(0, Estimator::raw));
  EXPECT_EQ(all, &impl.grid(1u << 30, Estimator::raw));
  EXPECT_NE(all, &impl.grid(0, Estimator::volume_true));
  EXPECT_EQ(&impl.grid(64, Estimator::volume_true), &impl.grid(100, Estimator::volume_true));
  EXPECT_EQ(&impl.grid(3, Estimator::volume_true),
            &impl.grid(3, Estimator::raw));  // none stored: the raw radii
  EXPECT_EQ(impl.grid(64, Estimator::volume_true).plan().view.count, 64u);
}

TEST(CollisionModel, CanBeUsedByManyThreadsAtOnce) {
  for (int round = 0; round < 5; ++round) {
    const auto a = makeModel(randomSpheres(500, 0.3, 20, 1), true),
               b = makeModel(randomSpheres(400, 0.3, 20, 2), true);
    std::vector<Overlap> overlaps(32);
    tbb::parallel_for(std::size_t{0}, overlaps.size(), [&](std::size_t i) {
      QueryContext context({Backend::cpu, 1 + static_cast<int>(i % 2)});
      PairQuery query;
      query.a = a.get();
      query.b = b.get();
      query.placement_b = at({0.3, 0, 0});
      query.prefix_a = i / 2 % 2 ? 100 : 0;
      overlaps[i] = context.overlap(query);
    });
    for (std::size_t i = 4; i < overlaps.size(); ++i) EXPECT_EQ(overlaps[i].volume, overlaps[i % 4].volume);
  }
}

}  // namespace
}  // namespace innersphere::test
