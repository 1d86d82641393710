#include "packer/ball_trees.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace innersphere {

BallTrees::BallTrees(std::span<const Ball> balls) {
  for (std::uint32_t i = 0; i < balls.size(); ++i) members_.push_back({balls[i], i});
  const auto size = [](const Member& m) { return std::ilogb(m.ball.radius); };
  std::stable_sort(members_.begin(), members_.end(),
                   [&](const Member& a, const Member& b) { return size(a) < size(b); });
  std::uint32_t begin = 0;
  for (std::uint32_t i = 1; i <= members_.size(); ++i) {
    if (i < members_.size() && size(members_[i]) == size(members_[begin])) continue;
    roots_.push_back(static_cast<std::uint32_t>(nodes_.size()));
    build(begin, i);
    begin = i;
  }
  for (int k = 0; k < 4; ++k) {
    for (const Member& member : members_)
      lanes_[k].push_back(static_cast<float>(k < 3 ? member.ball.centre[k] : member.ball.radius));
    lanes_[k].resize(members_.size() + kLeaf);
  }
}

void BallTrees::build(std::uint32_t begin, std::uint32_t end) {
  Point lower = Point::Constant(2), upper = Point::Constant(-2);
  for (std::uint32_t i = begin; i < end; ++i) {
    lower = lower.cwiseMin(members_[i].ball.centre);
    upper = upper.cwiseMax(members_[i].ball.centre);
  }
  Node node{{(lower + upper) / 2, 0}, begin, end, 0};
  for (std::uint32_t i = begin; i < end; ++i) {
    const Ball& ball = members_[i].ball;
    node.bounds.radius =
        std::max(node.bounds.radius, (ball.centre - node.bounds.centre).norm() + ball.radius);
  }
  node.bounds.radius *= 1 + 1e-12;  // rounding
  const std::size_t self = nodes_.size();
  nodes_.push_back(node);
  if (end - begin <= kLeaf) return;
  Eigen::Index axis = 0;
  (upper - lower).maxCoeff(&axis);
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(members_.begin() + begin, members_.begin() + half, members_.begin() + end,
                   [axis](const Member& a, const Member& b) {
                     return std::make_tuple(a.ball.centre[axis], a.index) <
                            std::make_tuple(b.ball.centre[axis], b.index);
                   });
  build(begin, half);
  nodes_[self].second = static_cast<std::uint32_t>(nodes_.size());
  build(half, end);
}

}  // namespace innersphere
