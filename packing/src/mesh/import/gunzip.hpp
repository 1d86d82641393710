// Unpacks files that gzip compressed.
#pragma once

#include <string>
#include <string_view>

namespace innersphere {

/// Returns what the bytes of a .gz file unpack to; `path` names it in messages. Throws Error bad_format: the
/// bytes are damaged or cut, or unpack to more than 1 GiB.
std::string gunzip(std::string_view bytes, const std::string& path);

}  // namespace innersphere
