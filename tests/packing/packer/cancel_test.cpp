// Work ends soon after the user wants that, however long its rounds are.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <thread>

#include "analytic_solids.hpp"
#include "innersphere/clump_solid.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"

namespace innersphere::test {
namespace {

// In the middle of a round of the plate below, which looks at 7,000,000 points.
constexpr long kEnough = 2'000'000, kSoonAfter = 4'000'000;

/// A plate so thin that the largest sphere fits at a million places. It counts what it is asked.
class ThinPlate : public AnalyticSolid {
 public:
  ThinPlate() : AnalyticSolid(1, {}) {}
  std::string name() const override { return "thin plate"; }
  long asked() const { return asked_; }

 protected:
  Vec3d nearest(const Vec3d& p) const override {
    ++asked_;
    const Vec3d half = halfSize();
    Vec3d q;
    for (int k = 0; k < 3; ++k) q[k] = std::clamp(p[k], -half[k], half[k]);
    if (q != p) return q;
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (half[k] - std::abs(p[k]) < half[axis] - std::abs(p[axis])) axis = k;
    }
    q[axis] = p[axis] < 0 ? -half[axis] : half[axis];
    return q;
  }
  bool inside(const Vec3d& p) const override {
    const Vec3d half = halfSize();
    return std::abs(p[0]) < half[0] && std::abs(p[1]) < half[1] && std::abs(p[2]) < half[2];
  }
  Vec3d halfSize() const override { return {0.5, 0.5, 0.0005}; }
  double unitVolume() const override { return 0.001; }

 private:
  mutable std::atomic<long> asked_ = 0;
};

PackOptions withThreads(int threads) {
  PackOptions options;
  options.spheres = 200;
  options.threads = threads;
  return options;
}

TEST(PackerCancel, EndsInTheMiddleOfARound) {
  for (const int threads : {1, 4}) {
    const ThinPlate plate;
    const auto caller = std::this_thread::get_id();
    int calls_after = -1;
    try {
      pack(plate, withThreads(threads), [&](const char*, double) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        const bool enough = plate.asked() > kEnough;
        calls_after += enough;
        return !enough;
      });
      ADD_FAILURE() << "not cancelled";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    EXPECT_EQ(calls_after, 0);
    EXPECT_LT(plate.asked(), kSoonAfter) << threads << " threads";
  }
}

TEST(PackerCancel, PassesOnWhatTheCallbackThrows) {
  const ThinPlate plate;
  EXPECT_THROW(pack(plate, withThreads(2),
                    [&](const char*, double) -> bool {
                      if (plate.asked() > kEnough) throw std::out_of_range("of the user");
                      return true;
                    }),
               std::out_of_range);
  EXPECT_LT(plate.asked(), kSoonAfter);
}

TEST(PackerCancel, EndsAClumpWhileItsLatticeIsMade) {
  constexpr long kFirst = 100'000;  // of 1,400,000
  const ThinPlate plate;
  ClumpOptions options;
  options.threads = 1;
  EXPECT_THROW(clumpSolid(plate, options, [&](const char*, double) { return plate.asked() <= kFirst; }),
               Error);
  EXPECT_LT(plate.asked(), 1'000'000);
}

}  // namespace
}  // namespace innersphere::test
