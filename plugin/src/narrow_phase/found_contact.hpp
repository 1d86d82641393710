// Holds what a search has found of the contact of a pair.
#pragma once

#include <optional>

#include "common/pair_motion.hpp"
#include "narrow_phase/contact_settings.hpp"
#include "narrow_phase/contact_transport.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds the contact of a pair, in either way of finding it.
struct FoundContact {
  virtual ~FoundContact() = default;

  /// Returns true if the shapes are as they were when it was asked last. It is to be asked once in each step.
  /// If they are not, what was found is forgotten.
  virtual bool hasSameShapes() { return true; }
  /// Evaluates the depth at the samples again, for where the bodies are now and gaps up to `step.needed`.
  /// Returns false if contact has to be searched for.
  virtual bool refine(const Placed& now, const StepAhead& step) = 0;
  /// Returns the volume that both share where they were last. Its torque is about the origin of the other
  /// packing, or of the only one. Returns null where that is not known, as for contacts that were found on
  /// the surfaces.
  virtual const Overlap* overlap() const { return nullptr; }

  const std::vector<ContactPatch>& patches() const { return memory.patches; }
  bool isKnown() const { return settings.has_value(); }
  void forget() { settings.reset(); }
  /// Notes that there are no contacts, as far as is known.
  void drop() {
    forget();
    memory.drop();
  }

  ContactTransport memory;
  /// The settings of the last search; nothing if there was none, or what it found does not hold any more.
  std::optional<ContactSettings> settings;
  /// Whether depth was evaluated on the surfaces. If not, contacts are only right where the bodies were.
  bool on_surfaces = false;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
