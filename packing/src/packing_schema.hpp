// What a packing file calls itself.
#pragma once

namespace innersphere {

inline constexpr char kPackingFormat[] = "innersphere-packing";
/// Rises when an older reader would misread a file; new optional entries alone do not raise it.
inline constexpr int kPackingFormatVersion = 1;

}  // namespace innersphere
