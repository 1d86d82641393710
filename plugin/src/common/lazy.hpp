// Makes a value when it is first asked for.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds a value that is made when it is first asked for. It is safe to ask from several threads at once.
template <typename T>
class Lazy {
 public:
  /// Returns the value, after make() has made it the first time.
  template <typename Make>
  const T& get(const Make& make) const {
    if (!made_.load(std::memory_order_acquire)) makeOnce(make);
    return *value_;
  }
  /// Returns true if it has been made.
  bool made() const { return made_; }

 private:
  template <typename Make>
  void makeOnce(const Make& make) const {
    std::call_once(once_, [&] {
      value_ = make();
      made_ = true;
    });
  }

  mutable std::once_flag once_;
  mutable std::unique_ptr<T> value_;
  mutable std::atomic<bool> made_{false};
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
