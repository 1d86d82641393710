// The grid that a device builds has the bytes of the CPU's.
#include <cuda_fp16.h>
#include <cuda_runtime.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "cases.hpp"
#include "core/grid_level.hpp"
#include "cuda/device_grid.hpp"
#include "device.hpp"
#include "grid/hash_grid.hpp"
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

/// A ball among the entries, in edges from the middle of its cell.
struct EntryBall {
  double x, y, z, radius;
};

EntryBall ballAt(const std::vector<device::EntryPair>& entries, std::size_t at) {
  const device::EntryPair& pair = entries[at / 2];
  const auto half = [&](unsigned bits) {
    return double{__half2float(__ushort_as_half(static_cast<unsigned short>(bits >> (at % 2 * 16))))};
  };
  return {half(pair.x), half(pair.y), half(pair.z), half(pair.radius)};
}

/// Entries hold their spheres, by a cell's thousandth and by a part of their radii, and are not much larger;
/// or, far beyond the cell, everything near it.
void expectEntries(const core::GridView& grid, const EntryBall& ball, double edge,
                   const std::array<double, 3>& middle, std::uint32_t place) {
  if (place == grid.count) {
    EXPECT_TRUE(std::isinf(ball.x));
    return;
  }
  const Sphere& s = grid.centred[place];
  const double x = (s.x - middle[0]) / edge, y = (s.y - middle[1]) / edge, z = (s.z - middle[2]) / edge;
  const double radius = s.radius / edge, moved = std::hypot(ball.x - x, ball.y - y, ball.z - z);
  const double far = std::max({std::fabs(x), std::fabs(y), std::fabs(z), radius});
  if (far > 128) {
    EXPECT_EQ(ball.x, 0);
    EXPECT_GT(ball.radius, 100);
    return;
  }
  const double rounded = 1e-6 * (1 + far) + 3e-7 * (grid.radius + grid.largest) / edge;  // single precision
  EXPECT_GE(ball.radius, 1.0019 * radius + moved - rounded);
  EXPECT_LE(ball.radius, 1.004 * radius + 2e-3 * (1 + far) + rounded);
}

void expectEntries(const HashGrid& of_cpu, const device::Grid& header) {
  const core::GridView& grid = of_cpu.view();
  const std::uint32_t all = core::padded(grid.count);
  const auto entries = fetch(header.entries, (grid.listed_count + all) / 2);
  const Vec3f& half = grid.half;
  for (std::size_t slot = 0; slot < of_cpu.tableSize(); ++slot) {
    const core::Cell& cell = grid.cells[slot];
    if (cell.count == 0) continue;
    const double edge = std::ldexp(1.0, grid.finest + static_cast<int>(cell.key >> (3 * core::kAxisBits)));
    const auto middle = [&](int axis, double corner) {
      const auto number = cell.key >> axis * core::kAxisBits & ((1u << core::kAxisBits) - 1);
      return (static_cast<double>(number) - 0.5) * edge - corner;
    };
    for (std::uint32_t at = cell.first; at < cell.first + core::padded(cell.count); ++at)
      expectEntries(grid, ballAt(entries, at), edge,
                    {middle(0, half.x), middle(1, half.y), middle(2, half.z)}, grid.listed[at]);
  }
  const double around = std::ldexp(1.0, core::levelOf(std::max({half.x, half.y, half.z})));
  for (std::uint32_t place = 0; place < all; ++place)
    expectEntries(grid, ballAt(entries, grid.listed_count + place), around, {0, 0, 0},
                  std::min(place, grid.count));
}

void expectSame(const HashGrid& of_cpu, const CudaGrid& of_device) {
  const device::Grid header = fetch(of_device.onDevice(), 1)[0];
  const core::GridView &x = of_cpu.view(), &y = header.view;
  ASSERT_EQ(x.count, y.count);
  ASSERT_EQ(x.cluster_count, y.cluster_count);
  ASSERT_EQ(x.listed_count, y.listed_count);
  ASSERT_EQ(x.hash_shift, y.hash_shift);
  EXPECT_EQ(x.finest, y.finest);
  EXPECT_EQ(x.grid_levels, y.grid_levels);
  EXPECT_EQ(std::memcmp(&x.centre, &y.centre, sizeof x.centre), 0);
  EXPECT_EQ(std::memcmp(&x.half, &y.half, sizeof x.half), 0);
  EXPECT_EQ(x.radius, y.radius);
  EXPECT_EQ(x.reach, y.reach);
  EXPECT_EQ(x.largest, y.largest);
  expectSame("spheres", x.spheres, y.spheres, x.count);
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
  expectEntries(of_cpu, header);
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
  Spheres spheres = randomSpheres(cases(20000, 2000), 0.1, 30, 1);
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
