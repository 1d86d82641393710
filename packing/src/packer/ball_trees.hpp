// Finds the balls of two placements that meet.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "packer/voxels.hpp"
#include "surface/lanes.hpp"

namespace innersphere {

/// Holds balls in binary trees of bounding balls, one for each size of ball: a large ball would make the
/// nodes above it large.
class BallTrees {
 public:
  explicit BallTrees(std::span<const Ball> balls);

  /// Calls meet(i, j, way, distance) for each ball i that meets ball j once it is moved; `way` leads from the
  /// centre of j to that of i.
  template <class Meet>
  void forMeeting(const Pose& pose, Meet&& meet) const {
    Moved moved;
    for (const Node& node : nodes_) moved.nodes.push_back(pose.apply(node.bounds.centre));
    for (const Member& member : members_) moved.members.push_back(pose.apply(member.ball.centre));
    for (std::uint32_t a : roots_) {
      for (std::uint32_t b : roots_) visit(moved, a, b, meet);
    }
  }

 private:
  static constexpr std::size_t kLeaf = 4;

  // More than the rounding to float of a distance in the unit cube, or to it from a copy beside that.
  static constexpr double kFloatSlack = 4e-6;

  struct Node {
    Ball bounds;
    std::uint32_t begin = 0, end = 0;  ///< its balls
    std::uint32_t second = 0;          ///< child, the first one follows the node; a leaf has none
  };
  struct Member {
    Ball ball;
    std::uint32_t index;  ///< as it was given
  };

  /// Where the centres are in the copy that was moved.
  struct Moved {
    std::vector<Point> nodes, members;
  };

  void build(std::uint32_t begin, std::uint32_t end);

  template <class Meet>
  void visit(const Moved& moved, std::uint32_t mine, std::uint32_t other, Meet& meet) const {
    const Node &a = nodes_[mine], &b = nodes_[other];
    const double reach = a.bounds.radius + b.bounds.radius;
    if ((moved.nodes[mine] - b.bounds.centre).squaredNorm() >= reach * reach) return;
    if (a.second == 0 && b.second == 0) {
      meetInLeaves(moved, a, b, meet);
    } else if (b.second == 0 || (a.second > 0 && a.bounds.radius > b.bounds.radius)) {
      for (std::uint32_t child : {mine + 1, a.second}) visit(moved, child, other, meet);
    } else {
      for (std::uint32_t child : {other + 1, b.second}) visit(moved, mine, child, meet);
    }
  }

  template <class Meet>
  void meetInLeaves(const Moved& moved, const Node& a, const Node& b, Meet& meet) const {
    // In float, those that are certainly apart are left out.
    FourFloats places[4];  // and radii
    for (int k = 0; k < 4; ++k) std::memcpy(&places[k], &lanes_[k][b.begin], sizeof places[k]);
    for (std::uint32_t i = a.begin; i < a.end; ++i) {
      const Point& x = moved.members[i];
      const FourFloats reaches = places[3] + static_cast<float>(members_[i].ball.radius + kFloatSlack);
      FourFloats gaps = -reaches * reaches;
      for (int k = 0; k < 3; ++k) {
        const FourFloats along = places[k] - static_cast<float>(x[k]);
        gaps += along * along;
      }
      for (unsigned near = signBits(gaps < FourFloats{}) & ((1u << (b.end - b.begin)) - 1); near != 0;
           near &= near - 1) {
        const std::uint32_t j = b.begin + static_cast<std::uint32_t>(std::countr_zero(near));
        const Point way = x - members_[j].ball.centre;
        const double reach = members_[i].ball.radius + members_[j].ball.radius, squared = way.squaredNorm();
        if (squared < reach * reach) meet(members_[i].index, members_[j].index, way, std::sqrt(squared));
      }
    }
  }

  std::vector<Member> members_;
  std::vector<float> lanes_[4];  // of these: centres and radii, and four more numbers
  std::vector<Node> nodes_;      // depth first
  std::vector<std::uint32_t> roots_;
};

}  // namespace innersphere
