#include "packer/ball_tree.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace innersphere {

BallTree::BallTree(std::span<const Ball> balls) {
  for (std::uint32_t i = 0; i < balls.size(); ++i) members_.push_back({balls[i], i});
  if (!balls.empty()) build(0, static_cast<std::uint32_t>(balls.size()));
}

std::uint32_t BallTree::build(std::uint32_t begin, std::uint32_t end) {
  const auto [lower, upper] = corners(begin, end);
  Node node;
  node.bounds = {(lower + upper) / 2, 0};
  node.is_leaf = end - begin <= kWidth;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Ball& ball = members_[i].ball;
    node.bounds.radius =
        std::max(node.bounds.radius, (ball.centre - node.bounds.centre).norm() + ball.radius);
  }
  node.bounds.radius *= 1 + 1e-12;  // rounding
  const auto add = [&](std::uint32_t child, const Ball& ball) {
    node.centres.set(node.count, ball.centre);
    node.radii[node.count] = static_cast<float>(ball.radius);
    node.children[node.count++] = child;
  };
  if (node.is_leaf) {
    for (std::uint32_t i = begin; i < end; ++i) add(i, members_[i].ball);
  } else {
    // Halves of halves.
    const std::uint32_t half = halve(begin, end), ends[] = {halve(begin, half), half, halve(half, end), end};
    for (std::uint32_t to : ends) {
      const std::uint32_t child = build(begin, to);
      add(child, nodes_[child].bounds);
      begin = to;
    }
  }
  nodes_.push_back(node);
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::pair<Point, Point> BallTree::corners(std::uint32_t begin, std::uint32_t end) const {
  Point lower = Point::Constant(2), upper = Point::Constant(-2);
  for (std::uint32_t i = begin; i < end; ++i) {
    lower = lower.cwiseMin(members_[i].ball.centre);
    upper = upper.cwiseMax(members_[i].ball.centre);
  }
  return {lower, upper};
}

std::uint32_t BallTree::halve(std::uint32_t begin, std::uint32_t end) {
  const auto [lower, upper] = corners(begin, end);
  Eigen::Index axis = 0;
  (upper - lower).maxCoeff(&axis);
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(members_.begin() + begin, members_.begin() + half, members_.begin() + end,
                   [axis](const Member& a, const Member& b) {
                     return std::make_tuple(a.ball.centre[axis], a.index) <
                            std::make_tuple(b.ball.centre[axis], b.index);
                   });
  return half;
}

BallTree::Moved BallTree::move(const Pose& pose) const {
  Moved moved;
  for (const Member& member : members_) moved.members.push_back(pose.apply(member.ball.centre));
  for (const Node& node : nodes_) {
    moved.nodes.push_back(pose.apply(node.bounds.centre));
    moved.children.push_back(node.centres);
    for (std::uint32_t k = 0; k < node.count && !node.is_leaf; ++k)
      moved.children.back().set(k, moved.nodes[node.children[k]]);
  }
  return moved;
}

}  // namespace innersphere
