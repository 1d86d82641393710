// Sorts rows into colours: those of one colour share no body, and can be solved at the same time.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/constraint_rows.hpp"
#include "solver/contact_rows.hpp"
#include "solver/counting_sort.hpp"
#include "solver/solver_bodies.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Constraints and blocks of contacts that can be solved at the same time, as places in Colouring::joints()
/// and in ContactRows.
struct Colour {
  int first_joint = 0, joints = 0;
  int first_block = 0, blocks = 0;
  bool alone = false;  ///< one after the other, for they may share bodies
};

/// Gives each pair the first colour that neither of its bodies has yet, constraints first, then pairs with
/// most points: a colour takes as long as the most that one of its pairs has, and so only the first take
/// long. Contacts with the fixed world, of which a body has one pair, come last: what stands on it is let in
/// least. A body with more pairs than there are colours leaves some that are solved alone.
class Colouring {
 public:
  /// Colours the rows of a group, and lays contacts out in blocks.
  void colour(const SolverBodies& bodies, const ConstraintRows& constraints, ContactRows& contacts);
  const std::vector<Colour>& colours() const { return colours_; }
  /// Returns the constraints in the order of their colours.
  const std::vector<int>& joints() const { return *joints_; }

 private:
  int colourOf(int a, int b, int movable);

  std::vector<std::uint64_t> taken_;  ///< of each body that can be moved, the colours it has
  std::vector<int> joint_colour_, pair_colour_;
  std::vector<int> pairs_;  ///< in the order of their colours
  CountingSort joint_order_, point_order_, pair_order_;
  const std::vector<int>* joints_ = nullptr;
  std::vector<Colour> colours_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
