#include "innersphere/patch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "innersphere/error.hpp"
#include "innersphere/vec3.hpp"
#include "patches/direction_groups.hpp"

namespace innersphere {

namespace {

/// A patch smaller than this fraction of the largest one is merged into a neighbour.
constexpr double kSmallestPart = 0.05;
/// A gap is a split if it is wider than this fraction of the extent, and too wide to be chance (see
/// widestGap).
constexpr float kSplitGap = 0.3f;

struct Item {
  const SphereContact* contact;
  Vec3f place;    ///< relative to the first contact: moments lose no digits far from the origin of A
  double weight;  ///< length of the area vector
};

Vec3d toVec(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

/// Sums over the items of a patch; addition merges two patches.
struct Group {
  Vec3d area{0, 0, 0};
  double weight = 0;
  double volume = 0;
  Vec3d moment{0, 0, 0};
  double second[6] = {};  ///< xx, yy, zz, xy, xz, yz

  // What follows from them:
  Vec3d normal{0, 0, 0}, centroid{0, 0, 0};
  double size = 0;

  void add(const Item& item) {
    const Vec3d p{item.place.x, item.place.y, item.place.z}, weighted = item.weight * p;
    area = area + toVec(item.contact->area);
    weight += item.weight;
    volume += item.contact->volume;
    moment = moment + weighted;
    const double products[6] = {weighted.x * p.x, weighted.y * p.y, weighted.z * p.z,
                                weighted.x * p.y, weighted.x * p.z, weighted.y * p.z};
    for (int i = 0; i < 6; ++i) second[i] += products[i];
  }
  void add(const Group& other) {
    area = area + other.area;
    weight += other.weight;
    volume += other.volume;
    moment = moment + other.moment;
    for (int i = 0; i < 6; ++i) second[i] += other.second[i];
  }
  /// Keeps the old normal where the area vectors cancel.
  void update() {
    size = std::sqrt(dot(area, area));
    centroid = 1 / weight * moment;
    if (size > 1e-9 * weight) normal = 1 / size * area;
  }
};

/// A run of items, by their numbers.
struct Run {
  std::uint32_t *begin, *end;
};

/// Where to split a run along its longest axis: items up to `at` are on one side.
struct Gap {
  float Vec3f::*axis = nullptr;  ///< null: nowhere
  float at = 0;
};

/// Of n points that are spread evenly at random, the widest gap is about ln(n) / n of their extent; only one
/// three times as wide counts.
Gap widestGap(const std::vector<Item>& items, const Run& run) {
  constexpr std::ptrdiff_t kFewest = 5;  // fewer leave no gap that is wide enough
  constexpr int kBuckets = 64;
  if (run.end - run.begin < kFewest) return {};
  Vec3f lo = items[*run.begin].place, hi = lo;
  for (const std::uint32_t* k = run.begin; k != run.end; ++k) {
    const Vec3f& p = items[*k].place;
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  const Vec3f extent = hi - lo;
  const float longest = std::max({extent.x, extent.y, extent.z});
  float Vec3f::*const axis = extent.x == longest ? &Vec3f::x : extent.y == longest ? &Vec3f::y : &Vec3f::z;
  const float n = static_cast<float>(run.end - run.begin);
  float widest = std::max(kSplitGap, 3 * std::log(n) / n) * longest;

  // A gap as wide as that leaves many buckets in a row empty: that mostly decides it.
  const float first = lo.*axis, scale = kBuckets / longest;
  const auto bucketOf = [&](float x) {
    return std::min(static_cast<int>((x - first) * scale), kBuckets - 1);
  };
  if (!(longest > 0) || !std::isfinite(scale)) return {};
  std::uint64_t filled = 0;
  for (const std::uint32_t* k = run.begin; k != run.end; ++k)
    filled |= std::uint64_t{1} << bucketOf(items[*k].place.*axis);
  std::uint64_t row = ~filled;  // a bit where 16 buckets are empty, from it on
  static_assert(kSplitGap * kBuckets > 16 + 2);
  for (int length = 1; length < 16; length *= 2) row &= row >> length;
  if (row == 0) return {};

  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  float lowest[kBuckets], highest[kBuckets];
  std::fill_n(lowest, kBuckets, kInfinity);
  std::fill_n(highest, kBuckets, -kInfinity);
  for (const std::uint32_t* k = run.begin; k != run.end; ++k) {
    const float x = items[*k].place.*axis;
    const int bucket = bucketOf(x);
    lowest[bucket] = std::min(lowest[bucket], x);
    highest[bucket] = std::max(highest[bucket], x);
  }
  Gap gap;
  float before = first;
  for (; filled != 0; filled &= filled - 1) {
    const int bucket = std::countr_zero(filled);
    if (lowest[bucket] - before > widest) {
      widest = lowest[bucket] - before;
      gap = {axis, before};
    }
    before = highest[bucket];
  }
  return gap;
}

/// Splits a run where its items leave a wide gap along its longest axis, again and again. Items keep their
/// order in each part.
void splitPlace(const std::vector<Item>& items, const Run& run, std::vector<Run>& parts) {
  static thread_local std::vector<std::uint32_t> beyond;
  const Gap gap = widestGap(items, run);
  if (!gap.axis) return parts.push_back(run);
  beyond.clear();
  std::uint32_t* middle = run.begin;
  for (const std::uint32_t* k = run.begin; k != run.end; ++k) {
    if (items[*k].place.*gap.axis <= gap.at) {
      *middle++ = *k;
    } else {
      beyond.push_back(*k);
    }
  }
  std::copy(beyond.begin(), beyond.end(), middle);
  splitPlace(items, {run.begin, middle}, parts);
  splitPlace(items, {middle, run.end}, parts);
}

bool larger(const Group& a, const Group& b) {
  return a.size > b.size;
}

/// Merges the smallest group into the one that is most like it in direction and place, until there are few
/// enough and none is tiny. Leaves them by falling size.
void mergeSmall(std::vector<Group>& groups, std::size_t max_groups, double extent2) {
  const double inverse_extent2 = extent2 > 0 ? 1 / extent2 : 0;
  while (groups.size() > 1) {
    const auto small = std::max_element(groups.begin(), groups.end(), larger);
    const auto large = std::min_element(groups.begin(), groups.end(), larger);
    if (groups.size() <= max_groups && !(small->size < kSmallestPart * large->size)) break;
    auto best = groups.end();
    double best_cost = std::numeric_limits<double>::infinity();
    for (auto group = groups.begin(); group != groups.end(); ++group) {
      const Vec3d apart = group->centroid - small->centroid;
      const double cost = 1 - dot(group->normal, small->normal) + inverse_extent2 * dot(apart, apart);
      if (group != small && (cost < best_cost || best == groups.end())) best = group, best_cost = cost;
    }
    best->add(*small);
    best->update();
    *small = groups.back();
    groups.pop_back();
  }
  // By insertion: keeps the order of equals, and allocates nothing.
  for (auto g = groups.begin(); g != groups.end(); ++g)
    std::rotate(std::upper_bound(groups.begin(), g, *g, larger), g, g + 1);
}

Patch toPatch(const Group& group, const Vec3d& origin) {
  const Vec3d& c = group.centroid;
  const double inverse = 1 / group.weight;
  const double* const second = group.second;
  const double xx = inverse * second[0] - c.x * c.x, yy = inverse * second[1] - c.y * c.y,
               zz = inverse * second[2] - c.z * c.z, xy = inverse * second[3] - c.x * c.y,
               xz = inverse * second[4] - c.x * c.z, yz = inverse * second[5] - c.y * c.z;
  Patch patch;
  patch.volume = group.volume;
  patch.area = group.size;
  patch.normal = group.normal;
  patch.centroid = c + origin;
  patch.covariance = {xx, xy, xz, xy, yy, yz, xz, yz, zz};
  return patch;
}

/// Kept from call to call.
struct Scratch {
  std::vector<Item> items, undirected;
  DirectionGroups directions;
  std::vector<std::uint32_t> first, order;  ///< of the items by direction
  std::vector<Run> parts;
  std::vector<Group> groups;
};

/// Lists the items of each direction, in their order.
void orderByDirection(Scratch& scratch, std::uint32_t directions) {
  std::vector<std::uint32_t>& first = scratch.first;
  first.assign(directions + 1, 0);
  const std::size_t count = scratch.items.size();
  for (std::size_t k = 0; k < count; ++k) ++first[scratch.directions.groupOf(k) + 1];
  for (std::uint32_t g = 0; g < directions; ++g) first[g + 1] += first[g];
  scratch.order.resize(count);
  for (std::size_t k = 0; k < count; ++k)
    scratch.order[first[scratch.directions.groupOf(k)]++] = static_cast<std::uint32_t>(k);
}

/// Lists the contacts as items, those without a direction apart. Returns the squared extent of their places.
double gatherItems(const SphereContact* contacts, std::size_t count, const Vec3d& origin, Scratch& scratch) {
  scratch.items.reserve(count);
  scratch.items.clear();
  scratch.undirected.clear();
  scratch.directions.clear(count);
  Vec3f lo{0, 0, 0}, hi{0, 0, 0};
  for (const SphereContact* contact = contacts; contact != contacts + count; ++contact) {
    const Vec3d area = toVec(contact->area), place = toVec(contact->centroid) - origin;
    const Vec3f p{static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z)};
    const double weight = norm(area);
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
    if (weight > 0 && std::isfinite(weight)) {
      scratch.items.push_back({contact, p, weight});
      scratch.directions.add(area, weight);
    } else {
      scratch.undirected.push_back({contact, p, 0});
    }
  }
  const Vec3f extent = hi - lo;
  return dot(extent, extent);
}

/// Makes a group of each run of items with one direction and no wide gap.
void makeGroups(const PatchOptions& options, Scratch& scratch) {
  const std::uint32_t directions = scratch.directions.group(options.max_angle);
  orderByDirection(scratch, directions);
  scratch.parts.clear();
  std::uint32_t* const order = scratch.order.data();
  for (std::uint32_t g = 0, begin = 0; g < directions; begin = scratch.first[g++]) {
    if (begin < scratch.first[g])
      splitPlace(scratch.items, {order + begin, order + scratch.first[g]}, scratch.parts);
  }
  scratch.groups.clear();
  for (const Run& part : scratch.parts) {
    Group& group = scratch.groups.emplace_back();
    for (const std::uint32_t* k = part.begin; k != part.end; ++k) group.add(scratch.items[*k]);
    group.update();
  }
}

/// Spheres that are pushed from all sides equally have no direction; their volume goes to the nearest patch.
void addUndirected(const std::vector<Item>& undirected, std::vector<Group>& groups) {
  for (const Item& item : undirected) {
    Group* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (Group& group : groups) {
      const Vec3d way = group.centroid - Vec3d{item.place.x, item.place.y, item.place.z};
      const double distance2 = dot(way, way);
      if (distance2 < least || !nearest) nearest = &group, least = distance2;
    }
    assert(nearest && "items with a direction make groups");
    nearest->volume += item.contact->volume;
  }
}

}  // namespace

void buildPatches(const SphereContact* contacts, std::size_t count, const PatchOptions& options,
                  std::vector<Patch>& patches) {
  if (options.max_patches == 0)
    throw Error(ErrorCode::bad_argument, "max_patches is 0; it must be at least 1");
  if (!(options.max_angle > 0)) throw Error(ErrorCode::bad_argument, "max_angle is not positive");
  patches.clear();
  if (count == 0) return;
  static thread_local Scratch scratch;
  const Vec3d origin = toVec(contacts[0].centroid);
  const double extent2 = gatherItems(contacts, count, origin, scratch);
  if (scratch.items.empty()) return;
  makeGroups(options, scratch);
  mergeSmall(scratch.groups, options.max_patches, extent2);
  addUndirected(scratch.undirected, scratch.groups);
  for (const Group& group : scratch.groups) patches.push_back(toPatch(group, origin));
}

}  // namespace innersphere
