#include "mesh/import/gunzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "innersphere/error.hpp"

namespace innersphere {
namespace {

constexpr std::size_t kMost = std::size_t{1} << 30;

/// zlib's state, which wants to be ended.
class Inflate {
 public:
  Inflate() {
    constexpr int kGzip = 16 + MAX_WBITS;
    if (inflateInit2(&stream, kGzip) != Z_OK) throw std::bad_alloc();
  }
  ~Inflate() { inflateEnd(&stream); }
  Inflate(const Inflate&) = delete;
  Inflate& operator=(const Inflate&) = delete;

  z_stream stream{};
};

}  // namespace

std::string gunzip(std::string_view bytes, const std::string& path) {
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::bad_format, path + " cannot be unpacked: " + what);
  };
  Inflate inflater;
  z_stream& stream = inflater.stream;
  std::string text;
  char block[1 << 16];
  while (true) {
    if (stream.avail_in == 0) {
      const std::size_t next = std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max());
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
      stream.avail_in = static_cast<uInt>(next);
      bytes.remove_prefix(next);
    }
    stream.next_out = reinterpret_cast<Bytef*>(block);
    stream.avail_out = sizeof block;
    const int status = inflate(&stream, Z_NO_FLUSH);
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    if (status == Z_BUF_ERROR) fail("it was cut, copy it again");
    if (status != Z_OK && status != Z_STREAM_END) fail("it is damaged, or was not compressed by gzip");
    text.append(block, sizeof block - stream.avail_out);
    if (text.size() > kMost) fail("it unpacks to more than 1 GiB");
    if (status != Z_STREAM_END) continue;
    // Compressed files may be put one behind the other.
    if (stream.avail_in == 0 && bytes.empty()) return text;
    if (inflateReset(&stream) != Z_OK) fail("it is damaged");
  }
}

}  // namespace innersphere
