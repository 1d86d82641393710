// Scenes repeat to the last bit from build to build, thread count to thread count and day to day. What moves
// them by a bit shows here, wanted or not; what is wanted is written into the table by
//
//     INNERSPHERE_UPDATE_GOLDEN=1 ./build/bin/scene_tests --gtest_filter='Golden*'
//
// and the same with scene_tests_float64. Promised where the arithmetic is the same: on the CPU, x86-64 with
// FMA (the C library's sines differ without), Bullet 3.24, contraction off; and for solids given by a
// formula. The other scenes are held to their truths, with tolerance.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "scenes/scene.hpp"
#include "scenes/world.hpp"

namespace innersphere::test {
namespace {

constexpr const char* kScenes[] = {"soft",        "drop",       "bounce",      "slide",      "roll",
                                   "flip",        "torsion",    "cradle",      "collisions", "stack",
                                   "mass-ratios", "chain-hang", "chain-swing", "chain-heavy"};
const std::string kTable =
    INNERSPHERE_GOLDEN_DIR "/golden_float" + std::to_string(8 * sizeof(btScalar)) + ".txt";

/// Of all places, orientations and velocities in a recording, bit by bit: 64-bit FNV-1a.
std::uint64_t hashOf(const demo::Recording& recording) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](const auto& numbers) {
    for (const double number : numbers) {
      unsigned char bytes[sizeof number];
      std::memcpy(bytes, &number, sizeof number);
      for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
    }
  };
  for (const demo::BodyState& state : recording.states) {
    add(state.position);
    add(state.rotation);
    add(state.velocity);
    add(state.spin);
  }
  return hash;
}

/// The hash, and for a human eye where the last body ends.
std::string lineOf(const demo::Recording& recording) {
  const auto& p = recording.last(recording.names.size() - 1).position;
  char line[160];
  std::snprintf(line, sizeof line, "%016llx  %.9g %.9g %.9g",
                static_cast<unsigned long long>(hashOf(recording)), p[0], p[1], p[2]);
  return line;
}

std::map<std::string, std::string> readTable() {
  std::map<std::string, std::string> table;
  std::ifstream file(kTable);
  for (std::string line, name; std::getline(file, line);) {
    std::istringstream words(line);
    words >> name >> std::ws;
    std::getline(words, table[name]);
  }
  return table;
}

TEST(Golden, ScenesMoveAsTheyDid) {
  std::map<std::string, std::string> table = readTable();
  const bool update = std::getenv("INNERSPHERE_UPDATE_GOLDEN") != nullptr;
  for (const char* name : kScenes) {
    demo::SceneOptions options;
    options.spheres = 100;
    options.seconds = 1;
    options.contact.backend = Backend::cpu;
    const demo::Scene& scene = demo::sceneNamed(name);
    const std::string actual = lineOf(demo::play(scene, options).recording);
    if (update) table[name] = actual;
    EXPECT_EQ(table[name], actual) << name << " moves in another way. It guards: " << scene.guards;
  }
  if (!update) return;
  std::ofstream file(kTable);
  for (const auto& [name, line] : table) file << name << "  " << line << "\n";
}

}  // namespace
}  // namespace innersphere::test
