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

/// Returns the same for copies that lie nearly upon the solid, by rising volume instead of depth: see
/// OverlapErrors::Estimate::deep. Nothing if there are fewer than ten.
std::vector<OverlapErrors::AtDepth> errorsOfDeep(std::vector<Finding> findings);

/// Returns the same for balls inside the solid, by rising volume: see OverlapErrors::Estimate::inside.
std::vector<OverlapErrors::AtDepth> errorsOfInside(std::vector<Finding> findings);

}  // namespace innersphere
