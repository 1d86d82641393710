// Foretells errors at a depth from those that were found near it.
#pragma once

#include <vector>

#include "innersphere/packing.hpp"

namespace innersphere {

/// Says what was found in one pose.
struct Finding {
  double depth, error;  ///< as of OverlapErrors::AtDepth
  double volume;        ///< that was found, relative to the solid's
};

/// Returns limits of the errors that others will have, by rising depth: see OverlapErrors::AtDepth. What has
/// no depth is left out.
std::vector<OverlapErrors::AtDepth> errorsByDepth(std::vector<Finding> findings);

/// Returns the same for kOverlapErrorPoses copies that lie nearly upon the solid, in one row: depths do not
/// count, and errors rise with a power of the volume. Nothing if one finds nothing.
std::vector<OverlapErrors::AtDepth> errorsOfDeep(const std::vector<Finding>& findings);

}  // namespace innersphere
