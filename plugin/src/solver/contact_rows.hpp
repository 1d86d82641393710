// Contacts of pairs of bodies as rows that are solved several pairs at a time.
#pragma once

#include <atomic>
#include <vector>

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include "narrow_phase/hill.hpp"
#include "solver/counting_sort.hpp"
#include "solver/lane_bodies.hpp"
#include "solver/lanes.hpp"
#include "solver/soft_step.hpp"
#include "solver/solver_bodies.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Two bodies that touch, and the points at which they do. Normals lead from b to a.
struct TouchingPair {
  int a = 0, b = 0;  ///< places of the bodies, a can be moved
  int begin = 0;     ///< of its points in ContactRows
  int count = 0;     ///< of its points
};

/// How a pass treats contacts.
enum class Pass {
  push,   ///< with what drives bodies apart that are in each other
  relax,  ///< without: the speed that this took is given back
  finish  ///< the same, and the substep ends: what was borne is added up, and carried to the next one
};

/// The contacts of a group. Call begin(), find() and collect(), then addBlock() with the pairs in the order
/// in which they are to be solved, prepare() and carry(), then passes over blocks, then writeBack().
class ContactRows {
 public:
  /// `wide`: with instructions that not every processor has.
  explicit ContactRows(bool wide = hasWideLanes()) : wide_(wide) {}

  /// Begins with so many manifolds.
  void begin(int count) { entries_.resize(static_cast<std::size_t>(count)); }
  /// Finds the points that push of the manifolds in [begin, end).
  void find(int begin, int end, btPersistentManifold** manifolds, const SolverBodies& bodies);
  /// Finds the pairs that all of them are of.
  void collect(SolverBodies& bodies);
  const std::vector<TouchingPair>& pairs() const { return pairs_; }

  void clearBlocks();
  /// Puts up to kLanes pairs, no two of which share a body that can be moved, into a block.
  void addBlock(const int* pairs, int count);
  int blocks() const { return static_cast<int>(blocks_.size()); }
  /// Returns the number of points that all blocks have room for.
  int points() const { return point_count_; }
  /// Returns the first of `count` blocks from `first` on that is of this part of them; parts are as dear.
  int partOf(int first, int count, int part, int parts) const;

  /// Takes over what holds for all rows of a step. `depth` is wanted at most, in sizes of the smaller body.
  void beginStep(const btContactSolverInfo& info, int substeps, btScalar depth);
  /// Fills the rows of a block.
  void prepare(int block, const SolverBodies& bodies);
  /// Adds the impulses that points have borne to what the next substep begins with, as Pass::finish does.
  void carry(int block, std::vector<BodyState>& states);
  /// Returns true if bodies are thrown back by some points, as restitution says.
  bool bounces() const { return bounces_; }
  /// Finds those that they reach in this substep. Bodies are only read.
  void findBounces(int block, const SolverBodies& bodies);
  void solve(int block, Pass pass, std::vector<BodyState>& states);
  /// Returns true if passes that push or relax have stopped a pair since it was asked last, so fast that it
  /// would have come deeper into each other within the step than is wanted. By one thread, between passes.
  bool takeImpact() { return impact_.exchange(false, std::memory_order_relaxed); }
  /// Returns true if passes that push have left as much of a speed to passes that relax since it was asked
  /// last: of a pair that arrives at each other.
  bool takeArrival() { return arrival_.exchange(false, std::memory_order_relaxed); }
  /// Tells the points what they have borne, and remembers what they have no place for.
  void writeBack(int block);
  /// Forgets that.
  void forget() { known_.clear(); }

  /// Returns the number of points that were left out because they are not finite.
  int broken() const { return broken_; }

 private:
  struct Source {
    btManifoldPoint* point;
    btPersistentManifold* manifold;
    bool flipped;  ///< the manifold has the bodies the other way round
  };
  /// A point of each pair of a block.
  struct PointLanes {
    Lanes3 normal_0, pivot_a, pivot_b;  ///< when the step begins; pivots are centres of curvature
    Lanes gap_0;                        ///< [m]
    Lanes radius_a, radius_b;           ///< from there to the place [m]
    Lanes3 axis_1, axis_2;              ///< of the hill of the depth; 0: the place stays on the bodies
    Lanes goes;                         ///< 1: the place turns with the bodies; 0: only along the axes
    Lanes fall_1, fall_2;               ///< inverse of how fast its slope falls; 0: there is no top [m]
    Lanes most_1, most_2;               ///< how far the place goes to the top, at most [m]
    Lanes still_1, still_2;             ///< radius of b where the place stays in the world, or 0 [m]
    Lanes a_11, a_12, a_22, b_11, b_12, b_22;     ///< how the bodies bend in these axes [1/m]
    Lanes3 normal, side_1, side_2, arm_a, arm_b;  ///< now
    Lanes gap;
    Lanes mass, mass_1, mass_2;           ///< what each row moves [kg]
    Lanes kept;                           ///< share of what is borne with which the next step begins
    Lanes rate, soft_mass, soft_impulse;  ///< of the spring that drives bodies apart
    Lanes spring;                         ///< 1: it is the user's, and acts in all passes
    Lanes fastest;                        ///< that bodies are driven apart [m/s]
    Lanes loaded;                         ///< share that it bears of a load for which that is too slow
    Lanes friction, rolling, spinning;
    Lanes mass_rolling, mass_spinning;  ///< [kg m^2]
    Lanes belt_1, belt_2;               ///< speeds of the surface [m/s]
    Lanes restitution;
    Lanes bounce;      ///< the speed at which the bodies leave in this substep [m/s]
    Lanes bounce_way;  ///< by how much they are further apart at its end, over the substep [m/s]
    Lanes impulse, impulse_1, impulse_2;  ///< of this substep [N s]
    Lanes roll_1, roll_2, spin;           ///< [N m s]
    Lanes sum, sum_1, sum_2;              ///< of the step [N s]
    /// Of the way on which a body turns the place, what the place goes along with.
    Lanes3 turns(const Lanes3& way) const {
      const Lanes rest = inAll(1) - goes;
      return way * goes + axis_1 * (dot(way, axis_1) * rest) + axis_2 * (dot(way, axis_2) * rest);
    }
  };
  struct Block {
    int a[kLanes], b[kLanes];
    int pair[kLanes];            ///< -1: nothing is in this lane
    int begin, count;            ///< in points_
    Lanes calm;                  ///< at this speed they come as deep into each other as is wanted [m/s]
    Lanes share;                 ///< of what they slide apart, to the place in the middle
    Lanes inverse_mass[2];       ///< of bodies that are not held [1/kg]
    Lanes reach_a, reach_b;      ///< of arms, squared [m^2]
    Lanes slender;               ///< inverse square of the way that changes masses too much [1/m^2]
    bool bounces, rolls, bends;  ///< what some of its points do
    bool bouncing;               ///< in this substep
    bool turned;                 ///< so far in this step that masses follow
  };
  /// What a pass takes from the speeds of pairs, and what passes that relax will take after it, at most
  /// [m/s].
  struct Slowed {
    Lanes now, later;
  };
  struct Entry {
    btPersistentManifold* manifold;  ///< null: there are none up to `number`
    int number;                      ///< among those that Bullet gave
    int place;                       ///< in its dispatcher
    int a, b;
    unsigned points;  ///< those that push: a bit for each
    int broken;       ///< the number of those that are not finite
    bool flipped;
  };

  void fillPlace(PointLanes& lanes, int lane, const Source& source, const TouchingPair& pair,
                 const SolverBodies& bodies) const;
  static btVector3 wayAhead(const PointLanes& lanes, int lane, const TouchingPair& pair, btScalar bend,
                            const SolverBodies& bodies);
  static void fillBends(PointLanes& lanes, int lane, const Source& source, const TouchingPair& pair,
                        const SolverBodies& bodies);
  static void fillForces(PointLanes& lanes, int lane, const btManifoldPoint& point, const TouchingPair& pair,
                         const SolverBodies& bodies);
  static void fillMasses(PointLanes& point, const LaneBodies& a, const LaneBodies& b,
                         const Lanes (&inverse_mass)[2], bool rolls);
  void renewMasses(int index, const std::vector<BodyState>& states);
  void fillTurning(PointLanes& lanes, int lane, const Source& source) const;
  void makeRoomFor(const Entry& entry);
  void remember(const TouchingPair& pair, int lane, const PointLanes* points);
  void fillSoftness(PointLanes& lanes, int lane, const btManifoldPoint& point, const TouchingPair& pair,
                    const SolverBodies& bodies) const;
  static void fillLoads(PointLanes* points, int count, int lane);
  static void loosen(PointLanes* points, const Source* sources, int count, int lane, btScalar wanted);
  // Position-independent code inlines what is declared so.
  inline void renewMassesOf(const Block& block, const std::vector<BodyState>& states);
  inline void carryBlock(const Block& block, std::vector<BodyState>& states);
  inline void solveBlock(int index, Pass pass, std::vector<BodyState>& states);
  INNERSPHERE_WIDE void carryWide(int index, std::vector<BodyState>& states);
  INNERSPHERE_WIDE void renewMassesWide(int index, const std::vector<BodyState>& states);
  INNERSPHERE_WIDE void solveWide(int index, Pass pass, std::vector<BodyState>& states);
  inline static bool hasTurnedFar(const Block& block, const PointLanes* points, const LaneBodies& a,
                                  const LaneBodies& b);
  inline static void follow(const Block& block, PointLanes& point, const LaneBodies& a, const LaneBodies& b);
  inline static void roll(PointLanes& point, const LaneBodies& a, const LaneBodies& b, const Lanes3& way,
                          Lanes3& to_a, Lanes3& to_b);
  inline static void solveFriction(const Block& block, PointLanes& point, LaneBodies& a, LaneBodies& b);
  inline void solveNormal(PointLanes& point, Pass pass, LaneBodies& a, LaneBodies& b, Slowed& slowed) const;

  std::vector<Entry> entries_;  ///< room for each manifold, then one for each that pushes
  std::vector<Entry> sorted_;
  CountingSort order_of_b_, order_;
  std::vector<Source> sources_;
  // By the place of a manifold in its dispatcher: which it is, and what all its points have borne on its
  // first body against rolling and spinning in the last substep of a step [N m s]. All threads write the
  // latter.
  std::vector<const btPersistentManifold*> known_;
  std::vector<btVector3> turnings_;
  std::vector<TouchingPair> pairs_;
  std::vector<Block> blocks_;
  std::vector<PointLanes> points_;  ///< some of them of an earlier, larger step
  int point_count_ = 0;
  Softness soft_, soft_on_fixed_;
  btScalar substep_ = 0;  ///< [s]
  btScalar substeps_ = 1;
  btScalar bounce_threshold_ = 0;  ///< [m/s]
  btScalar slop_ = 0;              ///< [m]
  bool warm_starting_ = true;
  btScalar depth_ = 0;  ///< that is wanted at most, in sizes of the smaller body
  std::atomic<bool> bounces_{false};
  std::atomic<bool> impact_{false}, arrival_{false};
  bool wide_;
  int movable_ = 0;
  int broken_ = 0;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
