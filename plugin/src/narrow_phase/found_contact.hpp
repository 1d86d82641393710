// What a search has found of the contact of a pair.
#pragma once

#include <optional>

#include "narrow_phase/contact_settings.hpp"
#include "narrow_phase/contact_transport.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

struct FoundContact {
  virtual ~FoundContact() = default;

  /// Whether the shapes are as they were when it was asked last; asked once in each step. If not, what was
  /// found is forgotten.
  virtual bool hasSameShapes() { return true; }
  /// Evaluates the depth at the samples again, for where the bodies are now and gaps up to `needed` [m].
  /// False if contact has to be searched for.
  virtual bool refine(const Placed& now, btScalar needed) = 0;
  /// The volume that both share where they were last. Its torque is about the origin of the other packing, or
  /// of the only one. Only for what was found by volumes.
  virtual const Overlap* overlap() const { return nullptr; }

  const std::vector<ContactPatch>& patches() const { return memory.patches; }
  bool isKnown() const { return settings.has_value(); }
  void forget() { settings.reset(); }
  /// There are no contacts, as far as is known.
  void drop() {
    forget();
    memory.patches.clear();
  }

  ContactTransport memory;
  /// Of the last search; nothing if there was none, or what it found does not hold any more.
  std::optional<ContactSettings> settings;
  /// Depth was evaluated on the surfaces. If not, contacts are only right where the bodies were.
  bool on_surfaces = false;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
