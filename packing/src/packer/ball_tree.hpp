// Finds the balls of two placements that meet.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "packer/voxels.hpp"
#include "surface/lanes.hpp"

namespace innersphere {

/// Holds balls in a tree of bounding balls, up to four to a node.
class BallTree {
 public:
  explicit BallTree(std::span<const Ball> balls);

  /// Calls meet(i, j, way, distance) for each ball i that meets ball j once it is moved; `way` leads from the
  /// centre of j to that of i.
  template <class Meet>
  void forMeeting(const Pose& pose, Meet&& meet) const {
    const Moved moved = move(pose);
    const auto root = static_cast<std::uint32_t>(nodes_.size());
    if (root > 0) visit(moved, root - 1, root - 1, meet);
  }

 private:
  static constexpr std::uint32_t kWidth = 4;

  // More than the rounding to float of a distance in the unit cube, or to it from a copy beside that.
  static constexpr double kFloatSlack = 4e-6;

  // Where a node has fewer children than lanes: nothing is near it.
  static constexpr float kFar = 1e3F;

  /// Centres side by side.
  struct Lanes {
    FourFloats along[3];

    void set(std::uint32_t lane, const Point& centre) {
      for (int k = 0; k < 3; ++k) along[k][lane] = static_cast<float>(centre[k]);
    }
  };

  /// Has up to four nodes, or up to four balls.
  struct Node {
    Ball bounds;
    std::uint32_t children[kWidth]{}, count = 0;
    bool is_leaf = false;  ///< its children are balls
    Lanes centres{{FourFloats{} + kFar, FourFloats{} + kFar, FourFloats{} + kFar}};
    FourFloats radii{};
  };
  struct Member {
    Ball ball;
    std::uint32_t index;  ///< as it was given
  };

  /// Where the centres are in the copy that was moved.
  struct Moved {
    std::vector<Point> nodes, members;
    std::vector<Lanes> children;  // of nodes that are no leaves
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end);
  std::uint32_t halve(std::uint32_t begin, std::uint32_t end);

  /// The box of some centres.
  std::pair<Point, Point> corners(std::uint32_t begin, std::uint32_t end) const;
  Moved move(const Pose& pose) const;

  /// Returns a bit for each ball that may meet another one: in float, those that are certainly apart are left
  /// out.
  static unsigned near(const Lanes& centres, FourFloats radii, const Point& centre, double radius) {
    const FourFloats reaches = radii + static_cast<float>(radius + kFloatSlack);
    FourFloats gaps = -reaches * reaches;
    for (int k = 0; k < 3; ++k) {
      const FourFloats along = centres.along[k] - static_cast<float>(centre[k]);
      gaps += along * along;
    }
    return signBits(gaps < FourFloats{});
  }

  template <class Do>
  static void forBits(unsigned bits, Do&& act) {
    for (; bits != 0; bits &= bits - 1) act(std::countr_zero(bits));
  }

  template <class Meet>
  void visit(const Moved& moved, std::uint32_t mine, std::uint32_t other, Meet& meet) const {
    const Node &a = nodes_[mine], &b = nodes_[other];
    if (a.is_leaf && b.is_leaf) {
      meetInLeaves(moved, a, b, meet);
    } else if (b.is_leaf || (!a.is_leaf && a.bounds.radius > b.bounds.radius)) {
      forBits(near(moved.children[mine], a.radii, b.bounds.centre, b.bounds.radius),
              [&](int k) { visit(moved, a.children[k], other, meet); });
    } else {
      forBits(near(b.centres, b.radii, moved.nodes[mine], a.bounds.radius),
              [&](int k) { visit(moved, mine, b.children[k], meet); });
    }
  }

  template <class Meet>
  void meetInLeaves(const Moved& moved, const Node& a, const Node& b, Meet& meet) const {
    for (std::uint32_t lane = 0; lane < a.count; ++lane) {
      const std::uint32_t i = a.children[lane];
      const Point& x = moved.members[i];
      const double radius = members_[i].ball.radius;
      forBits(near(b.centres, b.radii, x, radius), [&](int k) {
        const Member& member = members_[b.children[k]];
        const Point way = x - member.ball.centre;
        const double reach = radius + member.ball.radius, squared = way.squaredNorm();
        if (squared < reach * reach) meet(members_[i].index, member.index, way, std::sqrt(squared));
      });
    }
  }

  std::vector<Member> members_;
  std::vector<Node> nodes_;  // children before parents
};

}  // namespace innersphere
