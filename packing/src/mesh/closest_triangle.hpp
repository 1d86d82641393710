// Finds the nearest point of a set of triangles.
#pragma once

#include <memory>
#include <vector>

#include "innersphere/mesh.hpp"
#include "innersphere/solid.hpp"
#include "mesh/embree.hpp"
#include "mesh/triangle.hpp"

namespace innersphere {

/// Holds Embree's tree over the triangles. Embree works in float, so the tree is built over a centred copy of
/// unit diagonal with boxes rounded outwards, and serves only to leave out triangles that are certainly too
/// far; distances and the choice among the rest are in double and equal brute force bit for bit (the lowest
/// index wins a tie).
class ClosestTriangle {
 public:
  /// Builds the tree. `embree` is Embree's own configuration: a test names instructions with it that it may
  /// use. Throws std::runtime_error if Embree cannot be started or has no memory for it.
  explicit ClosestTriangle(const Mesh& mesh, const char* embree = nullptr);

  struct Nearest : ClosestPoint {
    const Triangle* triangle = nullptr;  ///< that the point lies on
  };

  /// Returns the nearest point; beyond `cutoff` [m] the distance is infinity.
  Nearest closest(const Vec3d& p, double cutoff) const;
  /// Returns 1 in front of the triangle, which is the nearest one, and -1 behind it, if the nearest point is
  /// clearly inside of it and farther than rounding; else 0.
  int sideOf(const Vec3d& p, const Triangle& nearest) const;

 private:
  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };

  struct Hit {
    double distance2 = std::numeric_limits<double>::infinity();
    unsigned triangle = 0;
    Vec3d point{};
  };

  Hit find(const Vec3d& p, double cutoff) const;
  Bounds unitBox(const Mesh& mesh, std::size_t triangle) const;

  std::vector<Triangle> triangles_;
  Vec3d centre_{};
  double to_unit_ = 1;
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
};

}  // namespace innersphere
