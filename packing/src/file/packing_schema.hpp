// What a packing file calls itself.
#pragma once

namespace innersphere {

inline constexpr char kPackingFormat[] = "innersphere-packing";
/// Rises when an older reader would misread a file; new optional entries alone do not raise it.
/// 2: places are relative to "origin", which version 1 does not know.
inline constexpr int kPackingFormatVersion = 2;

}  // namespace innersphere
