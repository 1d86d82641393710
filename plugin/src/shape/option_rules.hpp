// Says which options are allowed, and which hold for a pair.
#pragma once

#include "innersphere/contact_options.hpp"

class btCollisionShape;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Throws Error bad_argument if stiffness, damping or accuracy is negative or not finite.
void checkOptions(const ContactOptions& options);

/// Returns what combine() says for two shapes, each a packing or not.
ContactOptions optionsOfPair(const ContactOptions& world, const btCollisionShape& a,
                             const btCollisionShape& b);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
