// Sweeps over arrays that lie where a device reaches them.
#include <cuda_runtime.h>

#include <cmath>

#include "conformance.hpp"
#include "innersphere/error.hpp"

namespace innersphere::test {
namespace {

constexpr std::size_t kCount = 1000;

/// An array in memory that `allocate` gives.
template <typename T>
class Array {
 public:
  Array(cudaError_t (*allocate)(void**, std::size_t), cudaError_t (*release)(void*), std::size_t count)
      : release_(release) {
    EXPECT_EQ(allocate(reinterpret_cast<void**>(&data_), count * sizeof(T)), cudaSuccess);
  }
  ~Array() { release_(data_); }
  Array(const Array&) = delete;
  T* data() { return data_; }

 private:
  cudaError_t (*release_)(void*);
  T* data_ = nullptr;
};

cudaError_t onDevice(void** p, std::size_t bytes) {
  return cudaMalloc(p, bytes);
}
cudaError_t pinned(void** p, std::size_t bytes) {
  return cudaMallocHost(p, bytes);
}

class DeviceSweep : public testing::Test {
 protected:
  void SetUp() override {
    needDevice();
    Random random(3);
    pair.a = pair.b = model.get();
    for (std::size_t i = 0; i < kCount; ++i) {
      const Placement place = randomPlacement(random, random.uniform(0, 2.5));
      for (int row = 0; row < 3; ++row)
        matrices.insert(matrices.end(), {place.rotation[3 * row], place.rotation[3 * row + 1],
                                         place.rotation[3 * row + 2], place.translation[row]});
      matrices.insert(matrices.end(), {0, 0, 0, 1});
    }
    expected.resize(kCount);
    QueryContext({Backend::cpu})
        .sweep(pair, {kCount, matrices.data(), nullptr, nullptr}, {}, expected.data());
  }

  void expectAsExpected(const Overlap* overlaps) const {
    for (std::size_t i = 0; i < kCount; ++i) ASSERT_TRUE(sameBits(overlaps[i], expected[i])) << i;
  }

  std::shared_ptr<CollisionModel> model = makeModel(randomSpheres(500, 0.2, 30, 1), true);
  PairQuery pair;
  std::vector<double> matrices;
  std::vector<Overlap> expected;
};

TEST_F(DeviceSweep, OfADeviceIsUsedInPlace) {
  Array<double> poses(onDevice, cudaFree, matrices.size());
  Array<Overlap> overlaps(onDevice, cudaFree, kCount);
  ASSERT_EQ(cudaMemcpy(poses.data(), matrices.data(), matrices.size() * sizeof(double), cudaMemcpyDefault),
            cudaSuccess);
  for (const int device : {kCurrentDevice, kAllDevices}) {
    ASSERT_EQ(cudaMemset(overlaps.data(), 0xff, kCount * sizeof(Overlap)), cudaSuccess);
    QueryContextOptions options;  // automatic: the arrays say where it runs
    options.device = device;
    QueryContext context(options);
    context.sweep(pair, {kCount, poses.data(), nullptr, nullptr}, {}, overlaps.data());
    EXPECT_EQ(context.lastBackend(), Backend::cuda);
    std::vector<Overlap> home(kCount);
    ASSERT_EQ(cudaMemcpy(home.data(), overlaps.data(), kCount * sizeof(Overlap), cudaMemcpyDefault),
              cudaSuccess);
    expectAsExpected(home.data());
  }
}

TEST_F(DeviceSweep, ThatIsPinnedIsUsedInPlace) {
  Array<double> poses(pinned, cudaFreeHost, matrices.size());
  Array<Overlap> overlaps(pinned, cudaFreeHost, kCount);
  std::copy(matrices.begin(), matrices.end(), poses.data());
  QueryContext({Backend::cuda}).sweep(pair, {kCount, poses.data(), nullptr, nullptr}, {}, overlaps.data());
  expectAsExpected(overlaps.data());
}

/// A stream that lives as long as a test.
struct Stream {
  Stream() { EXPECT_EQ(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), cudaSuccess); }
  ~Stream() { cudaStreamDestroy(stream); }
  cudaStream_t stream = nullptr;
};

/// Poses come by a copy that is in the stream before, and results leave by one that is after: the host waits
/// once, at the end.
TEST_F(DeviceSweep, InAStreamKeepsItsOrder) {
  const Stream users;
  Array<double> poses(onDevice, cudaFree, matrices.size());
  Array<Overlap> overlaps(onDevice, cudaFree, kCount), home(pinned, cudaFreeHost, kCount);
  ASSERT_EQ(cudaMemset(poses.data(), 0xff, matrices.size() * sizeof(double)), cudaSuccess);
  QueryContext context;  // automatic: the stream says where it runs
  for (int again = 0; again < 2; ++again) {
    ASSERT_EQ(cudaMemcpyAsync(poses.data(), matrices.data(), matrices.size() * sizeof(double),
                              cudaMemcpyDefault, users.stream),
              cudaSuccess);
    context.startSweep(pair, {kCount, poses.data(), nullptr, nullptr}, {}, overlaps.data(), users.stream);
    EXPECT_EQ(context.lastBackend(), Backend::cuda);
    ASSERT_EQ(cudaMemcpyAsync(home.data(), overlaps.data(), kCount * sizeof(Overlap), cudaMemcpyDefault,
                              users.stream),
              cudaSuccess);
    ASSERT_EQ(cudaMemsetAsync(poses.data(), 0xff, matrices.size() * sizeof(double), users.stream),
              cudaSuccess);
  }
  ASSERT_EQ(cudaStreamSynchronize(users.stream), cudaSuccess);
  expectAsExpected(home.data());
  EXPECT_NO_THROW(context.waitSweep());
}

TEST_F(DeviceSweep, InAStreamNamesTheFirstPoseThatIsNone) {
  const std::size_t count = cases(40000, 40), bad = count - 5;
  const Stream users, other;
  std::vector<double> many;
  for (std::size_t i = 0; i < count; ++i)
    many.insert(many.end(), matrices.begin() + static_cast<std::ptrdiff_t>(16 * (i % kCount)),
                matrices.begin() + static_cast<std::ptrdiff_t>(16 * (i % kCount + 1)));
  Array<double> poses(pinned, cudaFreeHost, many.size());
  Array<Overlap> overlaps(pinned, cudaFreeHost, count);
  std::copy(many.begin(), many.end(), poses.data());
  poses.data()[16 * bad] = poses.data()[16 * (bad + 2)] = 7;
  QueryContext context({Backend::cuda});
  const Poses some{count, poses.data(), nullptr, nullptr};
  context.startSweep(pair, some, {}, overlaps.data(), users.stream);
  context.startSweep(pair, {kCount, poses.data(), nullptr, nullptr}, {}, overlaps.data(), users.stream);
  try {
    context.waitSweep();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument) << error.what();
    EXPECT_NE(std::string(error.what()).find("query " + std::to_string(bad) + ": "), std::string::npos)
        << error.what();
  }
  // Of two streams it takes the first; both are done when the wait returns, and what failed is forgotten.
  context.startSweep(pair, {kCount, poses.data(), nullptr, nullptr}, {}, overlaps.data(), users.stream);
  context.startSweep(pair, {kCount, poses.data(), nullptr, nullptr}, {}, overlaps.data(), other.stream);
  EXPECT_THROW(context.waitSweep(), Error);
  expectAsExpected(overlaps.data());
  context.startSweep(pair, {kCount, poses.data(), nullptr, nullptr}, {}, overlaps.data(), users.stream);
  EXPECT_NO_THROW(context.waitSweep());
  expectAsExpected(overlaps.data());
}

TEST_F(DeviceSweep, OfADeviceIsRefusedOnTheCpu) {
  Array<Overlap> overlaps(onDevice, cudaFree, kCount);
  QueryContext context({Backend::cpu});
  EXPECT_THROW(context.sweep(pair, {kCount, matrices.data(), nullptr, nullptr}, {}, overlaps.data()), Error);
}

}  // namespace
}  // namespace innersphere::test
