#include "solver/colouring.hpp"

#include <algorithm>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Colours that bodies are searched for, then those that are alone, and those with the fixed world.
constexpr int kColours = 64, kAlone = kColours, kFixed = kColours + 1, kAll = kColours + 2;

}  // namespace

int Colouring::colourOf(int a, int b, int movable) {
  std::uint64_t taken = 0;
  if (a < movable) taken |= taken_[static_cast<std::size_t>(a)];
  if (b < movable) taken |= taken_[static_cast<std::size_t>(b)];
  int colour = 0;
  while (colour < kColours && (taken >> colour & 1) != 0) ++colour;
  if (colour == kColours) return kAlone;
  const std::uint64_t mark = std::uint64_t(1) << colour;
  if (a < movable) taken_[static_cast<std::size_t>(a)] |= mark;
  if (b < movable) taken_[static_cast<std::size_t>(b)] |= mark;
  return colour;
}

void Colouring::colour(const SolverBodies& bodies, const ConstraintRows& constraints, ContactRows& contacts) {
  const int movable = bodies.movable();
  taken_.assign(static_cast<std::size_t>(movable), 0);
  joint_colour_.clear();
  for (int i = 0; i < constraints.count(); ++i)
    joint_colour_.push_back(colourOf(constraints.bodyA(i), constraints.bodyB(i), movable));
  // Pairs with as many points fill blocks best, too.
  constexpr int kMostPoints = 32;
  const int pair_count = static_cast<int>(contacts.pairs().size());
  const std::vector<int>& by_points = point_order_.sort(pair_count, kMostPoints + 1, [&](int i) {
    return kMostPoints - std::min(contacts.pairs()[static_cast<std::size_t>(i)].count, kMostPoints);
  });
  pair_colour_.clear();
  for (const int i : by_points) {
    const TouchingPair& pair = contacts.pairs()[static_cast<std::size_t>(i)];
    pair_colour_.push_back(pair.b == movable ? kFixed : colourOf(pair.a, pair.b, movable));
  }

  const auto jointColour = [&](int i) { return joint_colour_[static_cast<std::size_t>(i)]; };
  // Of by_points[i].
  const auto pairColour = [&](int i) { return pair_colour_[static_cast<std::size_t>(i)]; };
  joints_ = &joint_order_.sort(constraints.count(), kAll, jointColour);
  const std::vector<int>& order = pair_order_.sort(pair_count, kAll, pairColour);
  pairs_.clear();
  for (const int i : order) pairs_.push_back(by_points[static_cast<std::size_t>(i)]);

  colours_.clear();
  contacts.clearBlocks();
  std::size_t joint = 0, pair = 0;
  for (int colour = 0; colour < kAll; ++colour) {
    Colour& made = colours_.emplace_back();
    made.alone = colour == kAlone;
    made.first_joint = static_cast<int>(joint);
    while (joint < joints_->size() && jointColour((*joints_)[joint]) == colour) ++joint;
    made.joints = static_cast<int>(joint) - made.first_joint;
    made.first_block = contacts.blocks();
    while (pair < order.size() && pairColour(order[pair]) == colour) {
      std::size_t end = pair + 1;
      while (!made.alone && end < order.size() && end - pair < static_cast<std::size_t>(kLanes) &&
             pairColour(order[end]) == colour)
        ++end;
      contacts.addBlock(&pairs_[pair], static_cast<int>(end - pair));
      pair = end;
    }
    made.blocks = contacts.blocks() - made.first_block;
    if (made.joints == 0 && made.blocks == 0) colours_.pop_back();
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
