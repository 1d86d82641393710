// Tells a binary glTF file that was cut, which assimp takes for a file of another format.
#pragma once

#include <string>
#include <string_view>

namespace innersphere {

/// Throws Error bad_format, with the byte, if a binary glTF file ends before its header or one of its chunks
/// does. Nothing else is judged: what does not begin as such a file passes.
void requireWholeGlb(std::string_view bytes, const std::string& path);

}  // namespace innersphere
