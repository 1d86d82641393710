#include "innersphere/patch.hpp"

#include <algorithm>
#include <cmath>

#include "core/vec3.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

using core::Vec3r;

namespace {

/// A patch smaller than this share of the largest one is merged into a neighbour.
constexpr double kSmallestShare = 0.05;
/// A gap is a split if it is wider than this share of the extent, and too wide to be chance (see splitPlace).
constexpr double kSplitGap = 0.3;

struct Item {
  Vec3r area;
  Vec3r place;
  double weight;  ///< length of the area vector
  double volume;
  std::size_t group;
  std::size_t index;  ///< of its contact: decides between equals
};

/// Sums over the items of a patch; addition merges two patches.
struct Group {
  Vec3r area{0, 0, 0};
  double weight = 0;
  double volume = 0;
  Vec3r moment{0, 0, 0};
  Mat3d second{};
  Vec3r normal{0, 0, 0};

  void add(const Item& item) {
    area = area + item.area;
    weight += item.weight;
    volume += item.volume;
    moment = moment + item.weight * item.place;
    const double p[3] = {item.place.x, item.place.y, item.place.z};
    for (int i = 0; i < 9; ++i) second[i] += item.weight * p[i / 3] * p[i % 3];
  }
  void add(const Group& other) {
    area = area + other.area;
    weight += other.weight;
    volume += other.volume;
    moment = moment + other.moment;
    for (int i = 0; i < 9; ++i) second[i] += other.second[i];
  }
  double size() const { return std::sqrt(dot(area, area)); }
  Vec3r centroid() const { return 1 / weight * moment; }
  /// Keeps the old normal where the area vectors cancel.
  void updateNormal() {
    if (size() > 1e-9 * weight) normal = 1 / size() * area;
  }
};

/// Gives each item the group whose direction is nearest, and a new group to those that no group suits. Items
/// come by falling weight, so groups start from the surest directions.
void groupByDirection(std::vector<Item>& items, double max_angle) {
  const double least = std::cos(max_angle);
  struct Direction {
    Vec3r sum;
    double length;
  };
  static thread_local std::vector<Direction> sums;
  sums.clear();
  const auto nearest = [&](const Item& item, double& best) {
    std::size_t found = sums.size();
    for (std::size_t g = 0; g < sums.size(); ++g) {
      const double cosine = dot(item.area, sums[g].sum) / (item.weight * sums[g].length);
      if (cosine > best) best = cosine, found = g;
    }
    return found;
  };
  for (Item& item : items) {
    double best = least;
    item.group = nearest(item, best);
    if (item.group == sums.size()) sums.push_back({{0, 0, 0}, 0});
    Direction& direction = sums[item.group];
    direction.sum = direction.sum + item.area;
    direction.length = std::sqrt(dot(direction.sum, direction.sum));
  }
  // Once more with the final directions, so that early items are not held by where a group began.
  for (Item& item : items) {
    double best = -2;
    item.group = nearest(item, best);
  }
}

/// Splits [begin, end) where its items leave a wide gap along its longest axis, again and again; gives each
/// part a number of its own. Of n points that are spread evenly at random, the widest gap is about ln(n) / n
/// of their extent; only one three times as wide counts.
void splitPlace(Item* begin, Item* end, std::size_t& groups) {
  Vec3r lo = begin->place, hi = begin->place;
  for (const Item* item = begin; item != end; ++item) {
    lo = {std::min(lo.x, item->place.x), std::min(lo.y, item->place.y), std::min(lo.z, item->place.z)};
    hi = {std::max(hi.x, item->place.x), std::max(hi.y, item->place.y), std::max(hi.z, item->place.z)};
  }
  const Vec3r extent = hi - lo;
  const double longest = std::max({extent.x, extent.y, extent.z});
  double Vec3r::*axis = extent.x == longest ? &Vec3r::x : extent.y == longest ? &Vec3r::y : &Vec3r::z;
  std::sort(begin, end, [axis](const Item& a, const Item& b) {
    return a.place.*axis != b.place.*axis ? a.place.*axis < b.place.*axis : a.index < b.index;
  });
  const double n = static_cast<double>(end - begin);
  double widest = longest * std::max(kSplitGap, 3 * std::log(n) / n);
  Item* split = nullptr;
  for (Item* item = begin + 1; item < end; ++item) {
    const double gap = item->place.*axis - item[-1].place.*axis;
    if (gap > widest) widest = gap, split = item;
  }
  if (split && n > 2) {
    splitPlace(begin, split, groups);
    splitPlace(split, end, groups);
    return;
  }
  for (Item* item = begin; item != end; ++item) item->group = groups;
  ++groups;
}

/// Merges the smallest group into the one that is most like it in direction and place, until there are few
/// enough and none is tiny. Leaves them by falling size.
void mergeSmall(std::vector<Group>& groups, std::size_t max_groups, double extent2) {
  // By insertion: keeps the order of equals, and allocates nothing.
  const auto sort = [&] {
    for (auto g = groups.begin(); g != groups.end(); ++g) {
      const auto larger = [](const Group& a, const Group& b) { return a.size() > b.size(); };
      std::rotate(std::upper_bound(groups.begin(), g, *g, larger), g, g + 1);
    }
  };
  for (sort(); groups.size() > 1 &&
               (groups.size() > max_groups || groups.back().size() < kSmallestShare * groups.front().size());
       sort()) {
    const Group small = groups.back();
    groups.pop_back();
    Group* best = nullptr;
    double best_cost = 0;
    for (Group& group : groups) {
      const Vec3r apart = group.centroid() - small.centroid();
      const double cost =
          1 - dot(group.normal, small.normal) + (extent2 > 0 ? dot(apart, apart) / extent2 : 0);
      if (!best || cost < best_cost) best = &group, best_cost = cost;
    }
    best->add(small);
    best->updateNormal();
  }
}

Patch toPatch(const Group& group) {
  const Vec3r c = group.centroid();
  const double centre[3] = {c.x, c.y, c.z};
  Patch patch;
  patch.volume = group.volume;
  patch.area = group.size();
  patch.normal = {group.normal.x, group.normal.y, group.normal.z};
  patch.centroid = {c.x, c.y, c.z};
  for (int i = 0; i < 9; ++i)
    patch.covariance[i] = group.second[i] / group.weight - centre[i / 3] * centre[i % 3];
  return patch;
}

}  // namespace

void buildPatches(const SphereContact* contacts, std::size_t count, const PatchOptions& options,
                  std::vector<Patch>& patches) {
  if (options.max_patches == 0)
    throw Error(ErrorCode::bad_argument, "max_patches is 0; it must be at least 1");
  if (!(options.max_angle > 0)) throw Error(ErrorCode::bad_argument, "max_angle is not positive");
  patches.clear();

  // Places relative to the first one: moments lose no digits where the bodies meet far from the origin of A.
  static thread_local std::vector<Item> items, undirected;
  static thread_local std::vector<Group> groups;
  items.clear();
  undirected.clear();
  groups.clear();
  Vec3r lo{0, 0, 0}, hi{0, 0, 0}, origin{0, 0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    const SphereContact& contact = contacts[i];
    const Vec3r place{contact.centroid[0], contact.centroid[1], contact.centroid[2]};
    if (i == 0) origin = place;
    const Vec3r area{contact.area[0], contact.area[1], contact.area[2]}, local = place - origin;
    const Item item{area, local, std::sqrt(dot(area, area)), contact.volume, 0, i};
    (item.weight > 0 ? items : undirected).push_back(item);
    lo = {std::min(lo.x, local.x), std::min(lo.y, local.y), std::min(lo.z, local.z)};
    hi = {std::max(hi.x, local.x), std::max(hi.y, local.y), std::max(hi.z, local.z)};
  }
  if (items.empty()) return;
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.index < b.index;
  });
  groupByDirection(items, options.max_angle);

  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return a.group != b.group ? a.group < b.group : a.index < b.index;
  });
  std::size_t parts = 0;
  for (std::size_t begin = 0, end; begin < items.size(); begin = end) {
    const std::size_t group = items[begin].group;
    for (end = begin + 1; end < items.size() && items[end].group == group;) ++end;
    splitPlace(items.data() + begin, items.data() + end, parts);
  }
  groups.resize(parts);
  for (const Item& item : items) groups[item.group].add(item);
  for (Group& group : groups) group.updateNormal();
  mergeSmall(groups, options.max_patches, dot(hi - lo, hi - lo));

  // Spheres that are pushed from all sides equally have no direction; their volume goes to the nearest patch.
  for (const Item& item : undirected) {
    const auto distance2 = [&](const Group& group) {
      return dot(group.centroid() - item.place, group.centroid() - item.place);
    };
    std::min_element(groups.begin(), groups.end(), [&](const Group& a, const Group& b) {
      return distance2(a) < distance2(b);
    })->volume += item.volume;
  }
  for (const Group& group : groups) {
    patches.push_back(toPatch(group));
    Vec3d& c = patches.back().centroid;
    c = {c[0] + origin.x, c[1] + origin.y, c[2] + origin.z};
  }
}

}  // namespace innersphere
