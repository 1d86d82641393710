// Pictures and their files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace innersphere::demo {

/// An 8-bit sRGB picture, rows from top to bottom.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;  ///< r, g, b of each pixel

  Image(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * h * 3) {}
  std::uint8_t* pixel(int x, int y) { return pixels.data() + (static_cast<std::size_t>(y) * width + x) * 3; }
};

/// Writes a PNG file. Throws Error write_failed.
void writePng(const Image& image, const std::string& path);

}  // namespace innersphere::demo
