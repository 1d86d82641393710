// When all pairs are looked at at once.
#pragma once

#include <cstddef>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// What a pair knows of the looks at all pairs.
struct Look {
  bool wanted = false;     ///< asked for since the last one that it was part of
  std::size_t number = 0;  ///< of that one, or of the last one before it was new
};

/// Bullet asks for one pair at a time and does not tell when a step begins. But where a pair has moved since
/// the last look at all pairs, time has gone on, and another look brings all of them up to date that were
/// asked for since, with all threads or in one launch. Pairs that are new since the last look, or that it
/// left out, are brought up to date alone.
class LookCount {
 public:
  /// Whether a pair that has moved shows that it is time for another look.
  bool isDue(const Look& look) const { return look.number == number_; }
  void begin() { ++number_; }
  /// True if the pair was asked for: then it is part of the look.
  bool join(Look& look) const {
    if (look.wanted) look.number = number_;
    return look.wanted;
  }
  /// Bullet asks for the pair.
  void ask(Look& look) const {
    look.wanted = true;
    look.number = number_;
  }
  /// It has been brought up to date in the last look, and not been asked for since.
  bool isFresh(const Look& look) const { return look.number == number_ && !look.wanted; }

 private:
  std::size_t number_ = 1;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
