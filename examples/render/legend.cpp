#include "render/legend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace innersphere::demo {
namespace {

// Glyphs of 5 by 7 dots; the highest of the five bits is on the left.
constexpr std::string_view kGlyphs = "0123456789.%";
constexpr std::array<std::array<std::uint8_t, 7>, kGlyphs.size()> kDots{{
    {14, 17, 19, 21, 25, 17, 14},
    {4, 12, 4, 4, 4, 4, 14},
    {14, 17, 1, 2, 4, 8, 31},
    {31, 2, 4, 2, 1, 17, 14},
    {2, 6, 10, 18, 31, 2, 2},
    {31, 16, 30, 1, 1, 17, 14},
    {6, 8, 16, 30, 17, 17, 14},
    {31, 1, 2, 4, 8, 8, 8},
    {14, 17, 17, 14, 17, 17, 14},
    {14, 17, 17, 15, 1, 2, 12},
    {0, 0, 0, 0, 0, 12, 12},
    {24, 25, 2, 4, 8, 19, 3},
}};

// In dots: a glyph with its gap, a field of the row, and what is around.
constexpr int kAdvance = 6, kGlyphHeight = 7, kField = 34, kFieldHeight = 10, kAround = 6;

// A dot for so many rows of the picture.
constexpr int kRowsPerDot = 360;

using Rgb = std::array<std::uint8_t, 3>;

constexpr Rgb kInk{38, 50, 61}, kPaper{255, 255, 255};

Rgb rgbOf(const Colour& colour) {
  const auto byte = [](float x) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0f, 1.0f)));
  };
  return {byte(colour.r), byte(colour.g), byte(colour.b)};
}

/// Paints in dots, from the upper left corner of the legend.
class DotPainter {
 public:
  DotPainter(Image& image, int dot, int left, int top) : image_(image), dot_(dot), left_(left), top_(top) {}

  void fill(int x, int y, int width, int height, const Rgb& colour) {
    for (int row = y * dot_; row < (y + height) * dot_; ++row) {
      for (int column = x * dot_; column < (x + width) * dot_; ++column)
        std::copy(colour.begin(), colour.end(), image_.pixel(left_ + column, top_ + row));
    }
  }

  void write(const std::string& text, int middle, int y) {
    int x = middle - (static_cast<int>(text.size()) * kAdvance - 1) / 2;
    for (const char c : text) {
      const std::size_t glyph = kGlyphs.find(c);
      for (int row = 0; glyph != std::string_view::npos && row < kGlyphHeight; ++row) {
        for (int column = 0; column < 5; ++column) {
          if (kDots[glyph][row] >> (4 - column) & 1) fill(x + column, y + row, 1, 1, kInk);
        }
      }
      x += kAdvance;
    }
  }

 private:
  Image& image_;
  int dot_, left_, top_;
};

}  // namespace

void drawLegend(const Film& film, Image& image) {
  if (film.scale.empty()) return;
  const int fields = static_cast<int>(film.scale.size());
  const int width = fields * kField + 2 * kAround, height = kFieldHeight + kGlyphHeight + 5 * kAround / 2;
  const int dot = std::max(1, image.height / kRowsPerDot);
  if ((width + kAround) * dot > image.width || (height + kAround) * dot > image.height) return;
  DotPainter painter(image, dot, kAround * dot, image.height - (height + kAround) * dot);
  painter.fill(0, 0, width, height, kPaper);
  for (int i = 0; i < fields; ++i) {
    const ScaleStep& step = film.scale[static_cast<std::size_t>(i)];
    painter.fill(kAround + i * kField, kAround, kField, kFieldHeight, rgbOf(step.colour));
    painter.write(step.up_to, kAround + (i + 1) * kField, kAround + kFieldHeight + kAround / 2);
  }
}

}  // namespace innersphere::demo
