// Which options are allowed, and which hold for a pair.
#pragma once

#include "innersphere/contact_options.hpp"

class btCollisionShape;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Throws Error bad_argument for a number out of range.
void checkOptions(const ContactOptions& options);

/// What combine() says for two shapes, each a packing or not.
ContactOptions optionsOfPair(const ContactOptions& world, const btCollisionShape& a,
                             const btCollisionShape& b);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
