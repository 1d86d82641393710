#include <thrust/iterator/counting_iterator.h>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_select.cuh>

#include <algorithm>

#include "batch/overlapping_pairs.hpp"
#include "cuda/pair_sorter.hpp"
#include "cuda/warp.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kThreads = 256;
constexpr unsigned kLanes = 8;  ///< that sum one contact, one of PairValues each

unsigned blocksFor(std::size_t threads) {
  return static_cast<unsigned>((threads + kThreads - 1) / kThreads);
}

/// How a key is made up; see Batch::found_pairs.
struct Bits {
  unsigned a, b;
  __host__ __device__ unsigned queryOf(unsigned long long key) const {
    return static_cast<unsigned>(key >> b >> a);
  }
  __host__ __device__ std::uint32_t aOf(unsigned long long key) const {
    return static_cast<std::uint32_t>(key >> b & ((1ull << a) - 1));
  }
  __host__ __device__ std::uint32_t bOf(unsigned long long key) const {
    return static_cast<std::uint32_t>(key & ((1ull << b) - 1));
  }
};

__global__ void writePairs(const unsigned long long* keys, unsigned count, Bits bits, SpherePair* pairs) {
  const unsigned k = blockIdx.x * kThreads + threadIdx.x;
  if (k < count) pairs[k] = {bits.aOf(keys[k]), bits.bOf(keys[k])};
}

/// Evaluates the pairs. `by_b`: their keys without the sphere of A; `order`: their numbers.
__global__ void evaluatePairs(const __grid_constant__ Batch batch, const __grid_constant__ Query single,
                              const unsigned long long* keys, unsigned count, Bits bits, PairValues* values,
                              unsigned long long* by_b, unsigned* order) {
  const unsigned k = blockIdx.x * kThreads + threadIdx.x;
  if (k >= count) return;
  const unsigned long long key = keys[k];
  const unsigned number = bits.queryOf(key);
  const Query& query = batch.queries ? batch.queries[number] : single;
  const core::GridView &a = query.grids[0]->view, &b = query.grids[1]->view;
  const core::Pair pair = core::makePair(query.frame, load(a.spheres + query.grids[0]->places[bits.aOf(key)]),
                                         load(b.spheres + query.grids[1]->places[bits.bOf(key)]));
  const core::Contact contact = core::makeContact(pair);
  const Vec3d moment = core::lensMoment(pair, contact);
  const Vec3d area = contact.lens.rim_area * contact.n;
  values[k] = {{contact.lens.volume, moment.x, moment.y, moment.z, area.x, area.y, area.z}};
  by_b[k] = static_cast<unsigned long long>(number) << bits.b | bits.bOf(key);
  order[k] = k;
}

/// Whether an overlapping pair is the first of its sphere.
struct IsHead {
  const unsigned long long* keys;
  unsigned shift;
  __device__ bool operator()(unsigned k) const { return k == 0 || keys[k] >> shift != keys[k - 1] >> shift; }
};

/// What is summed of the overlapping pairs, and in which order.
struct Summands {
  const PairValues* values;
  const unsigned* order;  ///< null: as they are

  __device__ double of(unsigned k, unsigned value) const { return values[order ? order[k] : k].of[value]; }
};

/// The sums of many partners, side by side; all threads of a block call it, and value i comes to thread i.
__device__ double sumMany(const Summands& summands, unsigned begin, unsigned end,
                          PairValues (&partial_sums)[kPartialSums]) {
  static_assert(kPartialSums == kThreads, "a partial sum for each thread");
  PairValues partial{};
#pragma unroll 4  // to have several in flight
  for (unsigned k = begin + threadIdx.x; k < end; k += kPartialSums) {
#pragma unroll
    for (unsigned i = 0; i < PairValues::values; ++i) partial.of[i] += summands.of(k, i);
  }
  partial_sums[threadIdx.x] = partial;
  __syncthreads();
  double sum = 0;
  if (threadIdx.x < PairValues::values) {
    for (const PairValues& s : partial_sums) sum += s.of[threadIdx.x];
  }
  return sum;
}

/// kLanes take a contact, each sums one of its values; where there are many to sum, the whole block helps.
/// The largest spheres come first, so a block's contacts are far apart: no block gets several of these.
__global__ void writeContacts(const unsigned long long* keys, unsigned count, unsigned shift,
                              std::uint32_t sphere_mask, Summands summands, const unsigned* heads,
                              const unsigned* head_count, SphereContact* contacts) {
  constexpr unsigned kContacts = kThreads / kLanes;
  __shared__ PairValues partial_sums[kPartialSums];
  __shared__ double sums[kContacts][kLanes];
  const unsigned all = *head_count, blocks = (all + kContacts - 1) / kContacts;
  const unsigned row = threadIdx.x / kLanes, value = threadIdx.x % kLanes;
  const auto contactOf = [&](unsigned of_row) { return blockIdx.x + of_row * blocks; };
  const auto beginOf = [&](unsigned contact) { return contact < all ? heads[contact] : count; };
  if (blockIdx.x >= blocks) return;
  const unsigned contact = contactOf(row);
  const bool valid = contact < all;
  const unsigned begin = beginOf(contact), end = valid ? beginOf(contact + 1) : begin;
  double sum = 0;
  if (end - begin <= kPartialSums && value < PairValues::values) {
#pragma unroll 4
    for (unsigned k = begin; k < end; ++k) sum += summands.of(k, value);
  }
  for (unsigned r = 0; r < kContacts; ++r) {
    const bool many = r == row && end - begin > kPartialSums;
    if (!__syncthreads_or(many)) continue;
    const unsigned of_row = contactOf(r);
    const double total = sumMany(summands, beginOf(of_row), beginOf(of_row + 1), partial_sums);
    if (threadIdx.x < kLanes) sums[r][threadIdx.x] = total;
    __syncthreads();
    if (r == row) sum = sums[r][value];
  }
  const double volume = __shfl_sync(kAll, sum, 0, kLanes);
  if (!valid) return;
  constexpr unsigned kMoment = PairValues::moment, kArea = PairValues::area;
  if (value >= kMoment && value < kArea) sum = volume > 0 ? 1 / volume * sum : 0;
  SphereContact& to = contacts[contact];
  if (value == 0) {
    to.sphere = static_cast<std::uint32_t>(keys[begin] >> shift) & sphere_mask;
    to.volume = static_cast<float>(volume);
  } else if (value < kArea) {
    reinterpret_cast<float*>(&to.centroid)[value - kMoment] = static_cast<float>(sum);
  } else if (value < PairValues::values) {
    reinterpret_cast<float*>(&to.area)[value - kArea] = static_cast<float>(sum);
  }
}

/// The first item of each query, and their number. The key of item i is keys[heads ? heads[i] : i].
__global__ void writeFirst(const unsigned long long* keys, unsigned shift, const unsigned* heads,
                           const unsigned* head_count, unsigned count, unsigned queries, unsigned* first) {
  const unsigned query = blockIdx.x * kThreads + threadIdx.x;
  if (query > queries) return;
  const unsigned items = heads ? *head_count : count;
  unsigned lo = 0;
  for (unsigned hi = items; lo < hi;) {
    const unsigned middle = lo + (hi - lo) / 2;
    if (keys[heads ? heads[middle] : middle] >> shift < query) {
      lo = middle + 1;
    } else {
      hi = middle;
    }
  }
  first[query] = lo;
}

template <typename T>
void prepareList(PinnedList<T>& list, std::size_t items, unsigned queries) {
  list.items.reserve(items);
  list.first.reserve(queries + 1);
  if (items == 0) std::fill_n(list.first.data(), queries + 1, 0u);
}

int bitsFor(unsigned count) {
  int bits = 1;
  while (count - 1 >> bits != 0) ++bits;
  return bits;
}

}  // namespace

void CudaPairSorter::start(const Batch& batch, const Query& single, std::size_t found_pairs, Want want,
                           cudaStream_t stream) {
  if (found_pairs >> 31 != 0) {
    throw Error(ErrorCode::device_out_of_memory,
                "2^31 or more pairs of spheres overlap in one part of a batch; use shorter prefixes");
  }
  const Bits bits{batch.bits_a, batch.bits_b};
  const auto count = static_cast<unsigned>(found_pairs);
  sorted_.reserve(found_pairs);
  if (count > 0) {
    withScratch(scratch_, [&](void* p, std::size_t& size) {
      return cub::DeviceRadixSort::SortKeys(p, size, keys_.data(), sorted_.data(), static_cast<int>(count), 0,
                                            bitsFor(batch.count) + static_cast<int>(bits.a + bits.b), stream);
    });
  }
  if (want == Want::pairs) {
    PinnedList<SpherePair>& pairs = lists_.pairs;
    prepareList(pairs, found_pairs, batch.count);
    if (count == 0) return;
    writePairs<<<blocksFor(found_pairs), kThreads, 0, stream>>>(sorted_.data(), count, bits,
                                                                pairs.items.data());
    writeFirst<<<blocksFor(batch.count + 1), kThreads, 0, stream>>>(
        sorted_.data(), bits.a + bits.b, nullptr, nullptr, count, batch.count, pairs.first.data());
    INNERSPHERE_CUDA(cudaGetLastError());
    return;
  }
  for (PinnedList<SphereContact>& contacts : lists_.contacts) prepareList(contacts, found_pairs, batch.count);
  if (count == 0) return;
  values_.reserve(found_pairs);
  order_.reserve(found_pairs);
  sorted_order_.reserve(found_pairs);
  evaluatePairs<<<blocksFor(found_pairs), kThreads, 0, stream>>>(batch, single, sorted_.data(), count, bits,
                                                                 values_.data(), keys_.data(), order_.data());
  INNERSPHERE_CUDA(cudaGetLastError());
  sumContacts(batch.count, count, bits.b, bits.a, nullptr, lists_.contacts[0], stream);
  if (want == Want::contacts_of_a) return;
  withScratch(scratch_, [&](void* p, std::size_t& size) {
    return cub::DeviceRadixSort::SortPairs(p, size, keys_.data(), sorted_.data(), order_.data(),
                                           sorted_order_.data(), static_cast<int>(count), 0,
                                           bitsFor(batch.count) + static_cast<int>(bits.b), stream);
  });
  sumContacts(batch.count, count, 0, bits.b, sorted_order_.data(), lists_.contacts[1], stream);
}

void CudaPairSorter::sumContacts(unsigned queries, unsigned found_pairs, unsigned shift, unsigned sphere_bits,
                                 const unsigned* order, PinnedList<SphereContact>& to, cudaStream_t stream) {
  heads_.reserve(found_pairs);
  head_count_.reserve(1);
  withScratch(scratch_, [&](void* p, std::size_t& size) {
    return cub::DeviceSelect::If(p, size, thrust::counting_iterator<unsigned>(0), heads_.data(),
                                 head_count_.data(), static_cast<int>(found_pairs),
                                 IsHead{sorted_.data(), shift}, stream);
  });
  writeContacts<<<blocksFor(std::size_t{kLanes} * found_pairs), kThreads, 0, stream>>>(
      sorted_.data(), found_pairs, shift, (std::uint32_t{1} << sphere_bits) - 1, {values_.data(), order},
      heads_.data(), head_count_.data(), to.items.data());
  writeFirst<<<blocksFor(queries + 1), kThreads, 0, stream>>>(sorted_.data(), shift + sphere_bits,
                                                              heads_.data(), head_count_.data(), found_pairs,
                                                              queries, to.first.data());
  INNERSPHERE_CUDA(cudaGetLastError());
}

}  // namespace innersphere::device
