// Remembers what is known of the surface around the points that were looked at.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "packer/container.hpp"

namespace innersphere {

/// Holds points with a distance that the surface certainly keeps from them, and the side that they lie on.
/// Asking a solid whether a point is inside is expensive; mostly it follows from an entry nearby.
class ClearanceCache {
 public:
  struct Entry {
    Point at;
    double distance;  ///< positive inside, negative outside

    /// Returns how far the surface stays away from x; it is not positive if x is out of reach.
    double clearance(const Point& x) const { return std::abs(distance) - (x - at).norm(); }
  };

  /// Makes an empty cache. `margin` is more than the rounding error of any distance.
  explicit ClearanceCache(double margin) : margin_(margin) {}

  void add(const Point& at, double distance) {
    if (entries_.size() < kKept) {
      entries_.push_back({at, distance});
    } else {
      entries_[oldest_++ % kKept] = {at, distance};
    }
  }

  /// Returns the entry with the largest clearance at x, or null if none reaches x.
  const Entry* around(const Point& x) const {
    const Entry* best = nullptr;
    double most = margin_;
    for (const Entry& entry : entries_) {
      // Most are too far away, which shows without a root.
      if ((x - entry.at).squaredNorm() >= entry.distance * entry.distance) continue;
      const double clearance = entry.clearance(x);
      if (clearance > most) {
        most = clearance;
        best = &entry;
      }
    }
    return best;
  }

  /// Returns 1 inside, -1 outside, 0 if unknown; `clear` is the distance of x from the surface. If that empty
  /// ball meets the empty ball of an entry, both are on the same side.
  int side(const Point& x, double clear) const {
    for (const Entry& entry : entries_) {
      const double reach = std::abs(entry.distance) + clear;
      if ((x - entry.at).squaredNorm() >= reach * reach) continue;  // most, without a root
      if (entry.clearance(x) + clear > margin_) return entry.distance > 0 ? 1 : -1;
    }
    return 0;
  }

  /// Returns true if x is inside the solid, asked of the solid only if the entries do not tell. What is
  /// learnt is kept; `reach` bounds the distances that are of use.
  bool contains(const Container& container, const Point& x, double reach) {
    if (last_ < entries_.size() && reaches(entries_[last_], x)) return entries_[last_].distance > 0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (!reaches(entries_[i], x)) continue;
      last_ = i;
      return entries_[i].distance > 0;
    }
    return signedDistance(container, x, reach) > 0;
  }

  /// Returns the distance from the surface, negative outside, or `reach` if that is less. It is kept.
  double signedDistance(const Container& container, const Point& x, double reach) {
    const Container::Nearest nearest = container.closest(x, reach);
    const double distance = std::min(nearest.distance, reach);
    int found = side(x, distance);
    if (found == 0) found = container.contains(x, nearest) ? 1 : -1;
    add(x, found * distance);
    return found * distance;
  }

 private:
  // The search moves through neighbouring cells, so the last entries are the near ones.
  static constexpr std::size_t kKept = 64;

  bool reaches(const Entry& entry, const Point& x) const {
    const double reach = std::abs(entry.distance) - margin_;
    return reach > 0 && (x - entry.at).squaredNorm() < reach * reach;
  }

  double margin_;
  std::vector<Entry> entries_;
  std::size_t oldest_ = 0;
  std::size_t last_ = 0;  // entry that told where a point is: mostly it tells of the next one, too
};

}  // namespace innersphere
