#include "palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace innersphere::demo {

Colour paletteColour(std::size_t n) {
  constexpr std::array<Colour, 8> kColours{{{0.88f, 0.36f, 0.29f},
                                            {0.17f, 0.50f, 0.66f},
                                            {0.95f, 0.70f, 0.27f},
                                            {0.33f, 0.62f, 0.45f},
                                            {0.50f, 0.39f, 0.64f},
                                            {0.90f, 0.55f, 0.50f},
                                            {0.36f, 0.68f, 0.72f},
                                            {0.62f, 0.66f, 0.35f}}};
  return kColours[n % kColours.size()];
}

Colour rampColour(float value) {
  // Even steps in lightness, so that it also reads in grey.
  constexpr std::array<Colour, 5> kStops{{{0.25f, 0.16f, 0.45f},
                                          {0.19f, 0.38f, 0.60f},
                                          {0.16f, 0.58f, 0.56f},
                                          {0.48f, 0.78f, 0.38f},
                                          {0.98f, 0.88f, 0.28f}}};
  const float scaled = std::clamp(value, 0.0f, 1.0f) * (kStops.size() - 1);
  const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(scaled), kStops.size() - 2);
  const float t = scaled - static_cast<float>(i);
  const auto mix = [t](float a, float b) { return a + t * (b - a); };
  return {mix(kStops[i].r, kStops[i + 1].r), mix(kStops[i].g, kStops[i + 1].g),
          mix(kStops[i].b, kStops[i + 1].b)};
}

std::vector<Colour> radiusColours(const std::vector<Sphere>& spheres) {
  std::vector<Colour> colours;
  if (spheres.empty()) return colours;
  const auto [smallest, largest] = std::minmax_element(
      spheres.begin(), spheres.end(), [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
  const float low = std::log(smallest->radius);
  const float range = std::max(std::log(largest->radius) - low, 1e-6f);
  colours.reserve(spheres.size());
  for (const Sphere& s : spheres) colours.push_back(rampColour((std::log(s.radius) - low) / range));
  return colours;
}

}  // namespace innersphere::demo
