#include "file/packing_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

#include "common/bounds.hpp"
#include "common/frame_origin.hpp"
#include "innersphere/error.hpp"

namespace innersphere {
namespace {

template <class Number>
void append(std::string& text, Number x) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
}

// In the coordinates of the solid.
void appendLines(std::string& text, const Packing& packing) {
  const bool moved = packing.origin != Vec3d{};
  for (const Sphere& s : packing.spheres) {
    const std::array<float, 3> centre{s.x, s.y, s.z};
    for (int k = 0; k < 3; ++k) {
      if (moved) {
        append(text, packing.origin[k] + centre[k]);
      } else {
        append(text, centre[k]);
      }
      text += ' ';
    }
    append(text, s.radius);
    text += '\n';
  }
}

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == ';';
}

// The numbers of a line; false if there is anything else in it.
bool numbersOf(const char* p, const char* end, std::vector<double>& numbers) {
  numbers.clear();
  while (true) {
    while (p != end && isBlank(*p)) ++p;
    if (p == end || *p == '#') return true;
    if (*p == '+') ++p;
    double x;
    const auto [rest, error] = std::from_chars(p, end, x);
    if (error != std::errc{} || (rest != end && !isBlank(*rest) && *rest != '#') || numbers.size() == 4)
      return false;
    numbers.push_back(x);
    p = rest;
  }
}

// Of the balls themselves: nothing is known of the solid they stand for.
MassProperties massOf(const std::vector<Sphere>& spheres) {
  MassProperties mass;
  const auto volume = [](const Sphere& s) {
    return 4 * std::numbers::pi / 3 * std::pow(double{s.radius}, 3);
  };
  const auto middle = [](const Sphere& s) { return Vec3d{s.x, s.y, s.z}; };
  for (const Sphere& s : spheres) {
    mass.volume += volume(s);
    mass.centre_of_mass = mass.centre_of_mass + volume(s) * middle(s);
  }
  if (!(mass.volume > 0)) return {};
  mass.centre_of_mass = (1 / mass.volume) * mass.centre_of_mass;
  for (const Sphere& s : spheres) {
    const Vec3d d = middle(s) - mass.centre_of_mass;
    const double own = 0.4 * volume(s) * s.radius * s.radius;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        mass.inertia[3 * i + j] += (i == j ? own + volume(s) * dot(d, d) : 0) - volume(s) * d[i] * d[j];
      }
    }
  }
  return mass;
}

}  // namespace

std::string toXyzr(const Packing& packing) {
  std::string text;
  appendLines(text, packing);
  return text;
}

std::string toPly(const Packing& packing) {
  const char* place = packing.origin == Vec3d{} ? "float" : "double";
  std::ostringstream head;
  head << "ply\nformat ascii 1.0\ncomment inner-sphere packing, metres\nelement vertex "
       << packing.spheres.size() << '\n';
  for (char axis : {'x', 'y', 'z'}) head << "property " << place << ' ' << axis << '\n';
  head << "property float radius\nend_header\n";
  std::string text = head.str();
  appendLines(text, packing);
  return text;
}

Packing fromXyzr(const std::string& text) {
  struct Ball {
    Vec3d centre;
    double radius;
  };
  std::vector<Ball> balls;
  Bounds box = emptyBounds();
  std::vector<double> numbers;
  std::size_t line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const bool fine = numbersOf(text.data() + begin, text.data() + end, numbers);
    if (!fine || (numbers.size() != 4 && !numbers.empty())) {
      throw Error(ErrorCode::bad_format, "line " + std::to_string(line) + " is not four numbers x y z r");
    }
    if (!numbers.empty()) {
      balls.push_back({{numbers[0], numbers[1], numbers[2]}, numbers[3]});
      for (double side : {-numbers[3], numbers[3]})
        extend(box, balls.back().centre + Vec3d{side, side, side});
    }
    begin = end + 1;
  }
  Packing packing;
  // Places that are no numbers are for validate() to name.
  if (isFinite(box.max - box.min) && norm(centre(box)) < std::numeric_limits<float>::max()) {
    packing.origin = frameOrigin(box);
  }
  for (const Ball& ball : balls) {
    const Vec3d p = ball.centre - packing.origin;
    packing.spheres.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
                               static_cast<float>(ball.radius)});
  }
  std::stable_sort(packing.spheres.begin(), packing.spheres.end(),
                   [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
  packing.solid = massOf(packing.spheres);
  packing.provenance.options = "imported";
  return packing;
}

}  // namespace innersphere
