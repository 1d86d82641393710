// The grid that a device builds has the bytes of the CPU's.
#include <cuda_runtime.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "cuda_grid.hpp"
#include "device.hpp"
#include "hash_grid.hpp"
#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

using device::CudaGrid;

class DeviceGridTest : public testing::Test {
 protected:
  void SetUp() override { needDevice(); }
};

/// `used`: bytes of an item without what fills it up, which nobody has written.
template <typename T>
std::vector<T> fetch(const T* from, std::size_t count, std::size_t used = sizeof(T)) {
  std::vector<T> items(count);
  INNERSPHERE_CUDA(
      cudaMemcpy2D(items.data(), sizeof(T), from, sizeof(T), used, count, cudaMemcpyDeviceToHost));
  return items;
}

template <typename T>
void expectSame(const char* what, const T* of_cpu, const T* of_device, std::size_t count) {
  const std::vector<T> copy = fetch(of_device, count);
  EXPECT_EQ(std::memcmp(of_cpu, copy.data(), count * sizeof(T)), 0) << what;
}

void build(CudaGrid& grid, const Spheres& spheres) {
  grid.build(spheres.data(), planGrid(spheres.data(), spheres.size()), nullptr);
}

void expectSame(const HashGrid& of_cpu, const CudaGrid& of_device) {
  const device::Grid header = fetch(of_device.onDevice(), 1)[0];
  const core::GridView &x = of_cpu.view(), &y = header.view;
  ASSERT_EQ(x.count, y.count);
  ASSERT_EQ(x.cluster_count, y.cluster_count);
  ASSERT_EQ(x.listed_count, y.listed_count);
  ASSERT_EQ(x.hash_shift, y.hash_shift);
  EXPECT_EQ(x.finest, y.finest);
  EXPECT_EQ(x.tiers, y.tiers);
  EXPECT_EQ(std::memcmp(&x.centre, &y.centre, sizeof x.centre), 0);
  EXPECT_EQ(std::memcmp(&x.half, &y.half, sizeof x.half), 0);
  EXPECT_EQ(x.radius, y.radius);
  EXPECT_EQ(x.reach, y.reach);
  EXPECT_EQ(x.largest, y.largest);
  expectSame("spheres", x.spheres, y.spheres, x.count);
  expectSame("centred", x.centred, y.centred, x.count + 1);
  expectSame("ids", x.ids, y.ids, x.count);
  expectSame("cells", x.cells, y.cells, of_cpu.tableSize());
  expectSame("listed", x.listed, y.listed, x.listed_count);
  const std::vector<core::Cluster> clusters =
      fetch(y.clusters, y.cluster_count, offsetof(core::Cluster, count) + sizeof(std::uint32_t));
  for (std::uint32_t c = 0; c < x.cluster_count; ++c) {
    EXPECT_EQ(x.clusters[c].first, clusters[c].first);
    EXPECT_EQ(x.clusters[c].count, clusters[c].count);
    EXPECT_EQ(std::memcmp(&x.clusters[c].ball, &clusters[c].ball, sizeof(Sphere)), 0) << c;
  }

  // What only the device has.
  const std::vector<std::uint32_t> places = fetch(header.places, x.count);
  for (std::uint32_t id = 0; id < x.count; ++id) EXPECT_EQ(places[id], of_cpu.placeOf(id));
  const std::vector<Sphere> entries =
      fetch(header.entries, std::size_t{x.listed_count} + x.count + core::kListStep);
  for (std::size_t at = 0; at < entries.size(); ++at) {
    const std::uint32_t place = at < x.listed_count
                                    ? x.listed[at]
                                    : std::min(static_cast<std::uint32_t>(at - x.listed_count), x.count);
    EXPECT_EQ(std::memcmp(&entries[at], &x.centred[place], sizeof(Sphere)), 0);
  }
  const std::vector<Sphere> groups = fetch(header.groups, device::groupCount(x.cluster_count));
  for (std::uint32_t c = 0; c < x.cluster_count; ++c) {
    const Sphere &ball = x.clusters[c].ball, &group = groups[c / device::kGroup];
    const double dx = double{ball.x} - group.x, dy = double{ball.y} - group.y, dz = double{ball.z} - group.z;
    EXPECT_LE(std::sqrt(dx * dx + dy * dy + dz * dz) + ball.radius, group.radius * (1 + 1e-12));
  }
}

std::vector<Spheres> sphereSets() {
  return {randomSpheres(3000, 0.2, 30, 1),
          clusteredSpheres(1500, 8, 2),
          lattice(12, 0.25),
          concentricSpheres(300),
          randomSpheres(700, 0.5, 1e4, 3),
          dust(700, 4),
          moved(randomSpheres(500, 0.2, 30, 5), {1e5, -3e4, 2e5}),
          {{0, 0, 0, 1}},
          {{-3, 8, 1e6f, 1e-30f}},
          {{0, 0, 0, 1}, {-0.0f, 0, -0.0f, 0.5f}},
          Spheres(5000, Sphere{0.1f, 0.2f, 0.3f, 0.5f}),
          {{0, 0, 0, 1}, {1e9f, 1e9f, 1e9f, 1e-4f}, {-1e9f, 5, 5, 1e-4f}}};
}

TEST_F(DeviceGridTest, IsThatOfTheCpu) {
  int number = 0;
  for (const Spheres& spheres : sphereSets()) {
    SCOPED_TRACE(number++);
    CudaGrid grid(0);
    build(grid, spheres);
    expectSame(HashGrid(spheres), grid);
  }
}

/// Each grid follows every other in the same memory.
TEST_F(DeviceGridTest, MemoryOfOtherGridsDoesNotMatter) {
  CudaGrid grid(0);
  const std::vector<Spheres> sets = sphereSets();
  for (std::size_t step = 1; step < 4; ++step) {
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const Spheres& spheres = sets[i * step % sets.size()];
      SCOPED_TRACE(i * step % sets.size());
      build(grid, spheres);
      expectSame(HashGrid(spheres), grid);
    }
  }
}

/// Spheres that move a little find room in the memory of the second build.
TEST_F(DeviceGridTest, BuildingOnceMoreStaysInItsMemory) {
  Spheres spheres = randomSpheres(20000, 0.1, 30, 1);
  Random random(1);
  CudaGrid grid(0);
  build(grid, spheres);
  build(grid, spheres);
  const device::Grid header = fetch(grid.onDevice(), 1)[0];
  for (int step = 0; step < 5; ++step) {
    for (Sphere& s : spheres) s.radius *= static_cast<float>(random.uniform(0.999, 1));
    build(grid, spheres);
    const device::Grid now = fetch(grid.onDevice(), 1)[0];
    EXPECT_EQ(now.view.spheres, header.view.spheres);
    EXPECT_EQ(now.view.cells, header.view.cells);
    EXPECT_EQ(now.entries, header.entries);
  }
  expectSame(HashGrid(spheres), grid);
}

}  // namespace
}  // namespace innersphere::test
