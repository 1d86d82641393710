// Says what a packing file calls itself.
#pragma once

namespace innersphere {

/// This is the name of the format in each file.
inline constexpr char kPackingFormat[] = "innersphere-packing";
/// The version rises when an older reader would misread a file; new optional entries alone do not raise it.
/// In version 2 places are relative to "origin", which version 1 does not know.
inline constexpr int kPackingFormatVersion = 2;

/// This is the name of the format of spheres that cover a solid.
inline constexpr char kCoveringFormat[] = "innersphere-covering";
inline constexpr int kCoveringFormatVersion = 1;

}  // namespace innersphere
