// Binary data as text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace innersphere::demo {

/// Base 64 (RFC 4648) of `size` bytes, with padding.
std::string base64(const void* data, std::size_t size);

template <typename T>
std::string base64(const std::vector<T>& items) {
  return base64(items.data(), items.size() * sizeof(T));
}

}  // namespace innersphere::demo
