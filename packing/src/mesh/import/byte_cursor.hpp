// Walks through a binary file and never leaves it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

#include "innersphere/error.hpp"

namespace innersphere {

/// Gives the numbers of a binary file one after the other.
class ByteCursor {
 public:
  /// The bytes have to outlive the cursor; `path` is for messages.
  ByteCursor(std::string_view bytes, const std::string& path, std::endian order = std::endian::little)
      : bytes_(bytes), path_(path), swap_(order != std::endian::native) {}

  /// Returns the next number. Throws Error bad_format if the file ends before.
  template <class T>
  T take() {
    if (left() < sizeof(T))
      fail("the file ends in the middle of a number; it was cut, copy or export it again");
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + at_, sizeof(T));
    if (swap_) std::reverse(raw, raw + sizeof(T));
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

  void skip(std::size_t bytes) { at_ += std::min(bytes, left()); }
  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t place() const { return at_; }  ///< What messages about a face name.
  /// Throws Error bad_format with the file and the byte.
  [[noreturn]] void fail(const std::string& what, ErrorCode code = ErrorCode::bad_format) const {
    throw Error(code, path_ + ", byte " + std::to_string(at_) + ": " + what);
  }

 private:
  std::string_view bytes_;
  const std::string& path_;
  bool swap_;
  std::size_t at_ = 0;
};

}  // namespace innersphere
