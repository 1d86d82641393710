#include "packing_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "innersphere/error.hpp"
#include "vec3.hpp"

namespace innersphere {
namespace {

void append(std::string& text, float x) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
}

void appendLines(std::string& text, const std::vector<Sphere>& spheres) {
  for (const Sphere& s : spheres) {
    append(text, s.x);
    for (float x : {s.y, s.z, s.radius}) append(text += ' ', x);
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
  appendLines(text, packing.spheres);
  return text;
}

std::string toPly(const Packing& packing) {
  std::string text =
      "ply\nformat ascii 1.0\ncomment inner-sphere packing, metres\nelement vertex " +
      std::to_string(packing.spheres.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty float radius\nend_header\n";
  appendLines(text, packing.spheres);
  return text;
}

Packing fromXyzr(const std::string& text) {
  Packing packing;
  std::vector<double> numbers;
  std::size_t line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const bool fine = numbersOf(text.data() + begin, text.data() + end, numbers);
    if (!fine || (numbers.size() != 4 && !numbers.empty())) {
      throw Error(ErrorCode::bad_format, "line " + std::to_string(line) + " is not four numbers x y z r");
    }
    if (!numbers.empty()) {
      packing.spheres.push_back({static_cast<float>(numbers[0]), static_cast<float>(numbers[1]),
                                 static_cast<float>(numbers[2]), static_cast<float>(numbers[3])});
    }
    begin = end + 1;
  }
  std::stable_sort(packing.spheres.begin(), packing.spheres.end(),
                   [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
  packing.solid = massOf(packing.spheres);
  packing.provenance.options = "imported";
  return packing;
}

}  // namespace innersphere
