// Things to show and where they are over time: what scenes record, and what the picture and the replay draw.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere::demo {

/// Where an actor is: a rotation as a unit quaternion (x, y, z, w), then a translation [m].
struct Pose {
  std::array<float, 3> position{0, 0, 0};
  std::array<float, 4> rotation{0, 0, 0, 1};
};

/// sRGB, each component 0 to 1.
struct Colour {
  float r = 0.7f;
  float g = 0.7f;
  float b = 0.7f;
};

/// A place where two bodies press on each other.
struct ContactMark {
  std::array<float, 3> point{};
  std::array<float, 3> normal{};  ///< unit length
};

/// What actors look like. A shape without spheres is drawn by its surface, and the other way round.
struct Shape {
  std::string name;
  Surface surface;
  std::vector<Sphere> spheres;
};

/// A shape with a colour of its own.
struct Actor {
  std::uint32_t shape = 0;
  Colour colour;
};

/// How actors are drawn.
enum class View {
  surface,
  spheres,
  split  ///< surfaces on the left of the picture, spheres on the right
};

/// Direction from which to look; the distance follows from what has to be seen.
struct Viewpoint {
  double azimuth = 0.6;        ///< [rad] about the z axis, 0: from -y
  double elevation = 0.45;     ///< [rad] above the horizon
  double field_of_view = 0.5;  ///< [rad] vertical
  bool whole_film = false;     ///< replays show all that moves, not just what is there at the end
};

/// A line of plain words about a film, and whether what it is about came out as it should.
struct Note {
  std::string text;
  std::optional<bool> holds;  ///< empty: the film is too short to show it
};

/// A step of a scale of colours, and the value at which the next one begins, in digits and signs; empty for
/// the last.
struct ScaleStep {
  Colour colour;
  std::string up_to;
};

/// A recording. The z axis points up.
struct Film {
  std::string title;
  std::string caption;      ///< one line below the title
  std::vector<Note> notes;  ///< shown by replays
  Viewpoint viewpoint;
  std::vector<Shape> shapes;
  std::vector<Actor> actors;
  std::vector<Pose> poses;  ///< of all actors in the first frame, then in the second, ...
  std::vector<std::vector<ContactMark>> contacts;  ///< in each frame; empty: not recorded
  double frame_rate = 60;                          ///< [1/s]
  bool has_ground = true;                          ///< draw a floor at height `ground`
  float ground = 0;                                ///< [m]
  std::vector<ScaleStep> scale;                    ///< what colours mean, for pictures
  bool colour_by_radius = false;  ///< spheres show their radius instead of their actor's colour

  std::size_t frames() const { return actors.empty() ? 0 : poses.size() / actors.size(); }
  const Pose* frame(std::size_t index) const { return poses.data() + index * actors.size(); }
};

}  // namespace innersphere::demo
