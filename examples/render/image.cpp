#include "image.hpp"

#include <png.h>

#include "innersphere/error.hpp"

namespace innersphere::demo {

void writePng(const Image& image, const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  if (!png_image_write_to_file(&png, path.c_str(), 0, image.pixels.data(), 0, nullptr)) {
    throw Error(ErrorCode::write_failed, "cannot write the picture " + path + ": " + png.message);
  }
}

}  // namespace innersphere::demo
