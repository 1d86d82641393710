// Where contacts go.
#pragma once

#include <vector>

#include "innersphere/contact_options.hpp"
#include "narrow_phase/contact_point.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A look at all pairs hands out what it found with all threads, so that there is nothing left to do when
/// Bullet asks for the pairs, one after the other.
class ContactReceiver {
 public:
  virtual ~ContactReceiver() = default;
  /// Called by any thread, for bodies as they are now. False if that has to wait until Bullet asks.
  virtual bool receive(const std::vector<ContactPatch>& patches, const ContactOptions& options,
                       btScalar time_step) = 0;
  /// Asks for the memory that receive() writes to.
  virtual void fetchManifolds() const = 0;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
