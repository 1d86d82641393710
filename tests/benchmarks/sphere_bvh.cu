#include <cub/cub.cuh>

#include "core/pair.hpp"
#include "cuda/memory.hpp"
#include "sphere_bvh.hpp"

namespace innersphere::benchmarks {
namespace {

constexpr unsigned kThreads = 128;

struct Box {
  float lo[3], hi[3];
};

/// An inner node with the boxes of its children. A child below 0 is the sphere ~child.
struct alignas(16) Node {
  Box boxes[2];
  float largest[2];  ///< radius below each child
  int children[2];
  int parent;
  unsigned arrived;
};

__device__ unsigned long long spread(unsigned x) {
  unsigned long long v = x & 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

/// Codes of places in a box that is a little larger than that of the unit ball.
__global__ void makeCodes(const Sphere* spheres, int count, unsigned long long* codes, unsigned* order) {
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i >= count) return;
  const auto cell = [](float x) {
    return static_cast<unsigned>(fminf(fmaxf((x + 1.1f) / 2.2f, 0.0f), 0.999f) * (1 << 21));
  };
  codes[i] = spread(cell(spheres[i].x)) << 2 | spread(cell(spheres[i].y)) << 1 | spread(cell(spheres[i].z));
  order[i] = static_cast<unsigned>(i);
}

__global__ void gather(const Sphere* from, const unsigned* order, int count, Sphere* to) {
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < count) to[i] = from[order[i]];
}

/// Length of the common prefix of two codes; of equal ones their places decide.
__device__ int common(const unsigned long long* codes, int count, int i, int j) {
  if (j < 0 || j >= count) return -1;
  const unsigned long long difference = codes[i] ^ codes[j];
  return difference != 0 ? __clzll(static_cast<long long>(difference)) : 64 + __clz(i ^ j);
}

__global__ void makeNodes(const unsigned long long* codes, int count, Node* nodes, int* leaf_parents) {
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i >= count - 1) return;
  const int step = common(codes, count, i, i + 1) > common(codes, count, i, i - 1) ? 1 : -1;
  const int least = common(codes, count, i, i - step);
  int most = 2;
  while (common(codes, count, i, i + most * step) > least) most *= 2;
  int length = 0;
  for (int t = most / 2; t >= 1; t /= 2) {
    if (common(codes, count, i, i + (length + t) * step) > least) length += t;
  }
  const int j = i + length * step, of_node = common(codes, count, i, j);
  int split = 0;
  for (int t = (length + 1) / 2;; t = (t + 1) / 2) {
    if (common(codes, count, i, i + (split + t) * step) > of_node) split += t;
    if (t == 1) break;
  }
  const int middle = i + split * step + min(step, 0);
  const int first = min(i, j), last = max(i, j);
  nodes[i].arrived = 0;
  if (i == 0) nodes[i].parent = -1;
  for (int side = 0; side < 2; ++side) {
    const int child = middle + side;
    const bool leaf = side == 0 ? first == middle : last == middle + 1;
    nodes[i].children[side] = leaf ? ~child : child;
    if (leaf) {
      leaf_parents[child] = i;
    } else {
      nodes[child].parent = i;
    }
  }
}

__device__ Box unite(const Box& a, const Box& b) {
  Box c;
  for (int k = 0; k < 3; ++k) c.lo[k] = fminf(a.lo[k], b.lo[k]), c.hi[k] = fmaxf(a.hi[k], b.hi[k]);
  return c;
}

/// From each sphere upwards; the second child to come to a node goes on.
__global__ void makeBoxes(const Sphere* spheres, int count, const int* leaf_parents, Node* nodes) {
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i >= count) return;
  const Sphere s = spheres[i];
  Box box{{s.x - s.radius, s.y - s.radius, s.z - s.radius}, {s.x + s.radius, s.y + s.radius, s.z + s.radius}};
  float largest = s.radius;
  int child = ~i;
  for (int at = leaf_parents[i]; at >= 0;) {
    Node& node = nodes[at];
    const int side = node.children[0] == child ? 0 : 1;
    node.boxes[side] = box;
    node.largest[side] = largest;
    __threadfence();
    if (atomicAdd(&node.arrived, 1u) == 0) return;
    __threadfence();
    Box other;  // past the first-level cache, which may have it from before
    for (int k = 0; k < 3; ++k) {
      other.lo[k] = __ldcg(node.boxes[1 - side].lo + k);
      other.hi[k] = __ldcg(node.boxes[1 - side].hi + k);
    }
    box = unite(box, other);
    largest = fmaxf(largest, __ldcg(node.largest + 1 - side));
    child = at;
    at = node.parent;
  }
}

__device__ bool meets(const Box& box, const float (&p)[3], float radius) {
  float sum = 0;
  for (int k = 0; k < 3; ++k) {
    const float d = fmaxf(fmaxf(box.lo[k] - p[k], p[k] - box.hi[k]), 0.0f);
    sum += d * d;
  }
  return sum <= radius * radius;
}

/// A thread takes a sphere of one body down the tree of the other, and finds there what is at least as large
/// (or, from B, larger): every pair once, and no thread has many. Blocks of y take poses.
__global__ void __launch_bounds__(kThreads)
    traverse(bool from_a, const Sphere* own, int count, const Sphere* others, const Node* nodes,
             const core::Frame* frames, double* volumes, unsigned long long* pairs) {
  __shared__ core::Frame frame;
  const core::Frame& of_pose = frames[blockIdx.y];
  for (unsigned i = threadIdx.x; i < sizeof(core::Frame) / 8; i += kThreads)
    reinterpret_cast<double*>(&frame)[i] = reinterpret_cast<const double*>(&of_pose)[i];
  __syncthreads();
  const int i = static_cast<int>(blockIdx.x * kThreads + threadIdx.x);
  double volume = 0;
  unsigned long long found = 0;
  if (i < count) {
    const Sphere sphere = own[i];
    // Into the other's frame; matrices are rotations here. A little larger than rounding.
    const Vec3d turned = (from_a ? frame.matrix_a : frame.matrix_b) * Vec3d{sphere.x, sphere.y, sphere.z};
    const Vec3d in_world = from_a ? turned - frame.offset : turned + frame.offset;
    const double* m = (from_a ? frame.matrix_b : frame.matrix_a).m;
    const float p[3] = {static_cast<float>(m[0] * in_world.x + m[3] * in_world.y + m[6] * in_world.z),
                        static_cast<float>(m[1] * in_world.x + m[4] * in_world.y + m[7] * in_world.z),
                        static_cast<float>(m[2] * in_world.x + m[5] * in_world.y + m[8] * in_world.z)};
    const float radius = sphere.radius * 1.00001f + 1e-6f;
    int stack[64], top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes[stack[--top]];
      for (int side = 0; side < 2; ++side) {
        const bool enough = from_a ? node.largest[side] >= sphere.radius : node.largest[side] > sphere.radius;
        if (!enough || !meets(node.boxes[side], p, radius)) continue;
        const int child = node.children[side];
        if (child >= 0) {
          stack[top++] = child;
          continue;
        }
        const Sphere& other = others[~child];
        const core::Pair pair =
            from_a ? core::makePair(frame, sphere, other) : core::makePair(frame, other, sphere);
        const double sum = pair.ra + pair.rb;
        if (!(pair.distance2 < sum * sum)) continue;
        volume += core::makeContact(pair).lens.volume;
        ++found;
      }
    }
  }
  using Volumes = cub::BlockReduce<double, kThreads>;
  using Counts = cub::BlockReduce<unsigned long long, kThreads>;
  __shared__ typename Volumes::TempStorage of_volumes;
  __shared__ typename Counts::TempStorage of_counts;
  volume = Volumes(of_volumes).Sum(volume);
  found = Counts(of_counts).Sum(found);
  if (threadIdx.x != 0 || found == 0) return;
  atomicAdd(volumes + blockIdx.y, volume);
  atomicAdd(pairs + blockIdx.y, found);
}

}  // namespace

struct SphereBvh::Arrays {
  int count;
  DeviceArray<Sphere> given, sorted;
  DeviceArray<unsigned long long> codes, sorted_codes;
  DeviceArray<unsigned> order, sorted_order;
  DeviceArray<Node> nodes;
  DeviceArray<int> leaf_parents;
  DeviceArray<std::byte> scratch;
  mutable DeviceArray<core::Frame> frames;
  mutable DeviceArray<double> volumes;
  mutable DeviceArray<unsigned long long> pairs;
};

SphereBvh::SphereBvh(const std::vector<Sphere>& spheres) : arrays_(new Arrays) {
  const std::size_t n = spheres.size();
  arrays_->count = static_cast<int>(n);
  arrays_->given.reserve(n);
  arrays_->sorted.reserve(n);
  arrays_->codes.reserve(n);
  arrays_->sorted_codes.reserve(n);
  arrays_->order.reserve(n);
  arrays_->sorted_order.reserve(n);
  arrays_->nodes.reserve(n);
  arrays_->leaf_parents.reserve(n);
  INNERSPHERE_CUDA(
      cudaMemcpy(arrays_->given.data(), spheres.data(), n * sizeof(Sphere), cudaMemcpyHostToDevice));
  build();
}

SphereBvh::~SphereBvh() = default;

std::size_t SphereBvh::bytes() const {
  return static_cast<std::size_t>(arrays_->count) * (sizeof(Node) + sizeof(Sphere));
}

double SphereBvh::build() {
  Arrays& a = *arrays_;
  const auto blocks = (static_cast<unsigned>(a.count) + kThreads - 1) / kThreads;
  Event start, stop;
  INNERSPHERE_CUDA(cudaEventRecord(start.get()));
  makeCodes<<<blocks, kThreads>>>(a.given.data(), a.count, a.codes.data(), a.order.data());
  withScratch(a.scratch, [&](void* scratch, std::size_t& size) {
    return cub::DeviceRadixSort::SortPairs(scratch, size, a.codes.data(), a.sorted_codes.data(),
                                           a.order.data(), a.sorted_order.data(), a.count, 0, 63);
  });
  gather<<<blocks, kThreads>>>(a.given.data(), a.sorted_order.data(), a.count, a.sorted.data());
  makeNodes<<<blocks, kThreads>>>(a.sorted_codes.data(), a.count, a.nodes.data(), a.leaf_parents.data());
  makeBoxes<<<blocks, kThreads>>>(a.sorted.data(), a.count, a.leaf_parents.data(), a.nodes.data());
  INNERSPHERE_CUDA(cudaGetLastError());
  INNERSPHERE_CUDA(cudaEventRecord(stop.get()));
  INNERSPHERE_CUDA(cudaEventSynchronize(stop.get()));
  return secondsBetween(start, stop);
}

SphereBvh::Result SphereBvh::overlap(const SphereBvh& a, const std::vector<core::Frame>& poses) const {
  const Arrays& own = *arrays_;
  const std::size_t n = poses.size();
  own.frames.reserve(n);
  own.volumes.reserve(n);
  own.pairs.reserve(n);
  INNERSPHERE_CUDA(
      cudaMemcpy(own.frames.data(), poses.data(), n * sizeof(core::Frame), cudaMemcpyHostToDevice));
  INNERSPHERE_CUDA(cudaMemset(own.volumes.data(), 0, n * sizeof(double)));
  INNERSPHERE_CUDA(cudaMemset(own.pairs.data(), 0, n * sizeof(unsigned long long)));
  Event start, stop;
  INNERSPHERE_CUDA(cudaEventRecord(start.get()));
  for (const bool from_a : {true, false}) {
    const Arrays &searching = from_a ? *a.arrays_ : own, &searched = from_a ? own : *a.arrays_;
    const auto blocks = (static_cast<unsigned>(searching.count) + kThreads - 1) / kThreads;
    traverse<<<dim3(blocks, static_cast<unsigned>(n)), kThreads>>>(
        from_a, searching.sorted.data(), searching.count, searched.sorted.data(), searched.nodes.data(),
        own.frames.data(), own.volumes.data(), own.pairs.data());
  }
  INNERSPHERE_CUDA(cudaGetLastError());
  INNERSPHERE_CUDA(cudaEventRecord(stop.get()));
  Result result;
  result.volumes.resize(n);
  result.pairs.resize(n);
  INNERSPHERE_CUDA(
      cudaMemcpy(result.volumes.data(), own.volumes.data(), n * sizeof(double), cudaMemcpyDeviceToHost));
  INNERSPHERE_CUDA(cudaMemcpy(result.pairs.data(), own.pairs.data(), n * sizeof(unsigned long long),
                              cudaMemcpyDeviceToHost));
  result.kernel = secondsBetween(start, stop);
  return result;
}

}  // namespace innersphere::benchmarks
