// Says what a packing file calls itself.
#pragma once

namespace innersphere {

/// This is the name of the format in each file.
inline constexpr char kPackingFormat[] = "innersphere-packing";
/// The version rises when an older reader would misread a file; new optional entries alone do not raise it.
/// In version 2 places are relative to "origin", which version 1 does not know.
inline constexpr int kPackingFormatVersion = 2;

/// These are the names of the formats of spheres that overlap each other: those that contain a solid, and
/// clumps. Two names, so that no reader takes a clump for spheres that contain a solid.
inline constexpr char kCoveringFormat[] = "innersphere-covering";
inline constexpr char kClumpFormat[] = "innersphere-clump";
inline constexpr int kCoveringFormatVersion = 1;  ///< Of both.

}  // namespace innersphere
