// A value that is made when it is first asked for.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Safe to ask from several threads at once.
template <typename T>
class Lazy {
 public:
  template <typename Make>
  const T& get(const Make& make) const {
    if (!made_.load(std::memory_order_acquire)) {
      std::call_once(once_, [&] {
        value_ = make();
        made_ = true;
      });
    }
    return *value_;
  }
  /// Whether it has been asked for.
  bool made() const { return made_; }

 private:
  mutable std::once_flag once_;
  mutable std::unique_ptr<T> value_;
  mutable std::atomic<bool> made_{false};
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
