#include "solver/contact_rows.hpp"

#include <algorithm>
#include <cmath>

#include "common/bullet_vectors.hpp"
#include "solver/crew.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A face that lands flat is thrown back by all its corners in one substep: each of them goes on until the
/// others have had their part.
constexpr int kBounceRounds = 8;

bool isSound(const btManifoldPoint& point) {
  return isFinite(point.getPositionWorldOnA()) && isFinite(point.getPositionWorldOnB()) &&
         isFinite(point.m_normalWorldOnB) && std::isfinite(point.getDistance()) &&
         std::isfinite(point.m_combinedFriction) && std::isfinite(point.m_combinedRestitution) &&
         std::isfinite(point.m_combinedRollingFriction) && std::isfinite(point.m_combinedSpinningFriction);
}

/// Both parts of an impulse across the normal, which together are no larger than `most`.
void holdWithin(Lanes most, Lanes& along_1, Lanes& along_2) {
  const Lanes length = root(along_1 * along_1 + along_2 * along_2);
  const Lanes share = length > most ? most / length : inAll(1);
  along_1 *= share;
  along_2 *= share;
}

}  // namespace

void ContactRows::find(int begin, int end, btPersistentManifold** manifolds, const SolverBodies& bodies) {
  static_assert(MANIFOLD_CACHE_SIZE <= 32, "Entry::points has a bit for each");
  int next = begin;
  for (int i = begin; i < end; ++i) {
    btPersistentManifold& manifold = *manifolds[i];
    if (manifold.getNumContacts() == 0) continue;
    // Bullet leaves sensors out only where it looks for islands.
    if (!manifold.getBody0()->hasContactResponse() || !manifold.getBody1()->hasContactResponse()) continue;
    Entry entry{};
    entry.manifold = &manifold;
    entry.number = i;
    entry.place = manifold.m_index1a;
    entry.a = bodies.placeOf(*manifold.getBody0());
    entry.b = bodies.placeOf(*manifold.getBody1());
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      // Bullet's own measure of which points its solver is to leave alone.
      if (point.getDistance() > manifold.getContactProcessingThreshold()) continue;
      if (isSound(point))
        entry.points |= 1u << k;
      else
        ++entry.broken;
    }
    entries_[static_cast<std::size_t>(next++)] = entry;
  }
  // Most manifolds of a pile have no points: collect() need not look at them.
  if (next == end) return;
  entries_[static_cast<std::size_t>(next)].manifold = nullptr;
  entries_[static_cast<std::size_t>(next)].number = end;
}

void ContactRows::collect(SolverBodies& bodies) {
  broken_ = 0;
  movable_ = bodies.movable();
  const auto pushes = [&](Entry& entry) {
    broken_ += entry.broken;
    if (entry.points == 0) return false;
    // Those that are not known are few, and new to the bodies.
    if (entry.a == SolverBodies::kOther) entry.a = bodies.indexOf(*entry.manifold->getBody0());
    if (entry.b == SolverBodies::kOther) entry.b = bodies.indexOf(*entry.manifold->getBody1());
    if (entry.a == SolverBodies::kBroken || entry.b == SolverBodies::kBroken) return false;
    entry.flipped = entry.a > entry.b;
    if (entry.flipped) std::swap(entry.a, entry.b);
    return bodies.isMovable(entry.a);
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < entries_.size();) {
    Entry& entry = entries_[i];
    if (entry.manifold == nullptr) {
      i = static_cast<std::size_t>(entry.number);
      continue;
    }
    if (pushes(entry)) entries_[count++] = entry;
    ++i;
  }
  // By their numbers they are in order already.
  const int all = static_cast<int>(count);
  const std::vector<int>& by_b = order_of_b_.sort(all, static_cast<int>(bodies.states().size()), [&](int i) {
    return entries_[static_cast<std::size_t>(i)].b;
  });
  const auto entryOf = [&](int i) -> const Entry& {
    return entries_[static_cast<std::size_t>(by_b[static_cast<std::size_t>(i)])];
  };
  sorted_.clear();
  for (const int i : order_.sort(all, movable_, [&](int k) { return entryOf(k).a; }))
    sorted_.push_back(entryOf(i));
  sources_.clear();
  pairs_.clear();
  for (const Entry& entry : sorted_) {
    makeRoomFor(entry);
    if (pairs_.empty() || pairs_.back().a != entry.a || pairs_.back().b != entry.b)
      pairs_.push_back({entry.a, entry.b, static_cast<int>(sources_.size()), 0});
    for (int k = 0; k < MANIFOLD_CACHE_SIZE; ++k) {
      if ((entry.points >> k & 1u) == 0) continue;
      sources_.push_back({&entry.manifold->getContactPoint(k), entry.manifold, entry.flipped});
      ++pairs_.back().count;
    }
  }
}

/// A manifold that has come to the place of another has not borne anything.
void ContactRows::makeRoomFor(const Entry& entry) {
  const auto place = static_cast<std::size_t>(entry.place);
  if (known_.size() <= place) {
    known_.resize(place + 1);
    turnings_.resize(place + 1);
  }
  if (known_[place] == entry.manifold) return;
  known_[place] = entry.manifold;
  turnings_[place].setZero();
}

void ContactRows::clearBlocks() {
  blocks_.clear();
  point_count_ = 0;
}

void ContactRows::addBlock(const int* pairs, int count) {
  Block& block = blocks_.emplace_back();
  block.begin = point_count_;
  block.count = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    block.pair[lane] = lane < count ? pairs[lane] : -1;
    if (lane < count)
      block.count = std::max(block.count, pairs_[static_cast<std::size_t>(pairs[lane])].count);
  }
  point_count_ += block.count;
  if (points_.size() < static_cast<std::size_t>(point_count_))
    points_.resize(static_cast<std::size_t>(point_count_));
}

/// A block takes about as long as one point more than it has.
int ContactRows::partOf(int first, int count, int part, int parts) const {
  const auto costBefore = [&](int i) {
    return (i < blocks() ? blocks_[static_cast<std::size_t>(i)].begin : point_count_) + i;
  };
  const int begin = costBefore(first), end = costBefore(first + count);
  const int from = 2 * (begin + Crew::boundOf(end - begin, part, parts));
  // Where its middle lies decides.
  int low = first, high = first + count;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (costBefore(middle) + costBefore(middle + 1) < from)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/// How the place goes over both bodies, while these move by u and turn normals by t_a and t_b: with their
/// bends A and B, to x on B where the normals agree again,
///   (A + B) x = A u + t_a - t_b = c,
/// so that the normal turns by B x + t_b, and the gap, which is stationary there, grows by
///   u A u / 2 + t_a u - c x / 2 - (c - (A + B) x) x / 2,
/// of which the last is of a place that does not go as far as that. All is of second order. What turns is
/// taken about the centres of the strongest curvatures: for spheres and cylinders nothing is neglected.
/// Where next to nothing is left of A + B, x could be anything. There the normal keeps its direction,
/// x = -t_b / B: the row is a plane between the centres of curvature. A bore that turns on its pin by t, and
/// keeps the place, would be lifted by r t^2 / 2 in each step.
void ContactRows::roll(PointLanes& point, const LaneBodies& a, const LaneBodies& b, const Lanes3& way,
                       Lanes3& to_a, Lanes3& to_b) {
  const Lanes half = inAll(btScalar(0.5));
  const Lanes3 &axis_1 = point.axis_1, &axis_2 = point.axis_2;
  const Lanes3 turn_a = swing(a.axis, a.w, point.normal_0), turn_b = swing(b.axis, b.w, point.normal_0);
  const Lanes ta_1 = dot(turn_a, axis_1), ta_2 = dot(turn_a, axis_2), tb_1 = dot(turn_b, axis_1),
              tb_2 = dot(turn_b, axis_2), ra = point.radius_a, rb = point.radius_b;
  const Lanes u_1 = dot(way, axis_1) - ta_1 * ra - tb_1 * rb, u_2 = dot(way, axis_2) - ta_2 * ra - tb_2 * rb;
  const Lanes au_1 = point.a_11 * u_1 + point.a_12 * u_2, au_2 = point.a_12 * u_1 + point.a_22 * u_2;
  const Lanes c_1 = au_1 + ta_1 - tb_1, c_2 = au_2 + ta_2 - tb_2;
  const Lanes still_1 = tb_1 * point.still_1, still_2 = tb_2 * point.still_2;
  const Lanes x_1 = within(point.most_1, c_1 * point.fall_1) - still_1,
              x_2 = within(point.most_2, c_2 * point.fall_2) - still_2;
  const Lanes n_1 = point.b_11 * x_1 + point.b_12 * x_2 + tb_1,
              n_2 = point.b_12 * x_1 + point.b_22 * x_2 + tb_2;
  // By how much A's normal differs there.
  const Lanes off_1 = au_1 + ta_1 - point.a_11 * x_1 - point.a_12 * x_2 - n_1,
              off_2 = au_2 + ta_2 - point.a_12 * x_1 - point.a_22 * x_2 - n_2;
  const Lanes grows = half * ((ta_1 * ta_1 + ta_2 * ta_2) * ra + (tb_1 * tb_1 + tb_2 * tb_2) * rb +
                              (au_1 + ta_1 + ta_1) * u_1 + (au_2 + ta_2 + ta_2) * u_2 - c_1 * x_1 -
                              c_2 * x_2 - off_1 * x_1 - off_2 * x_2);
  const Lanes way_1 = dot(way, axis_1), way_2 = dot(way, axis_2), aside = way_1 * way_1 + way_2 * way_2,
              left = aside + (grows + grows) * (point.gap - point.gap_0);
  const auto exact = (grows > Lanes{}) & (left > inAll(btScalar(0.1)) * aside);
  point.gap +=
      exact ? (grows + grows) * aside / (left + root(left * left + inAll(4) * grows * grows * aside)) : grows;
  const Lanes sooner = exact ? aside / left : inAll(1);
  const Lanes3 turned = point.normal_0 + axis_1 * n_1 * sooner + axis_2 * n_2 * sooner;
  const Lanes length = root(dot(turned, turned));
  point.normal = turned * (length > Lanes{} ? inAll(1) / length : Lanes{});
  point.side_1 = point.side_1 - point.normal * dot(point.side_1, point.normal);
  point.side_2 = point.side_2 - point.normal * dot(point.side_2, point.normal);
  const Lanes3 bent = point.normal - point.normal_0;
  to_a =
      to_a + axis_1 * (x_1 - u_1 + (n_1 - ta_1) * ra) + axis_2 * (x_2 - u_2 + (n_2 - ta_2) * ra) - bent * ra;
  to_b = to_b + axis_1 * (x_1 - (n_1 - tb_1) * rb) + axis_2 * (x_2 - (n_2 - tb_2) * rb) + bent * rb;
}

/// Where the bodies touch now.
void ContactRows::follow(const Block& block, PointLanes& point, const LaneBodies& a, const LaneBodies& b) {
  const Lanes3 moved = a.moved - b.moved;
  const Lanes3 swung_a = swing(a.axis, a.w, point.pivot_a), swung_b = swing(b.axis, b.w, point.pivot_b);
  const Lanes3 way = moved + swung_a - swung_b;
  point.gap = point.gap_0 + dot(way, point.normal_0);
  // As seen from their origins.
  Lanes3 to_a = point.turns(swung_a), to_b = point.turns(swung_b);
  if (block.bends) roll(point, a, b, way, to_a, to_b);
  // Both feel the push at one place, so that it turns them as much as it would turn one body: in the middle,
  // or where A is of what moves by itself.
  const Lanes3 apart = moved + point.normal_0 * point.gap_0 + to_a - to_b;
  point.arm_a = point.pivot_a - point.normal_0 * point.radius_a + to_a - apart * block.share;
  point.arm_b = point.pivot_b + point.normal_0 * point.radius_b + to_b + apart * (inAll(1) - block.share);
}

/// Whether arms and normals may have changed so much, as their bodies see them, that rows over-relax: with
/// the bodies, and as places go along bent surfaces, further than either body moves where these nearly fit.
bool ContactRows::hasTurnedFar(const Block& block, const PointLanes* points, const LaneBodies& a,
                               const LaneBodies& b) {
  const Lanes3 moved = a.moved - b.moved;
  const Lanes turned = dot(a.axis, a.axis) * block.reach_a + dot(b.axis, b.axis) * block.reach_b;
  Lanes way = dot(moved, moved) + turned * inAll(4);  // an axis has half of the angle
  for (int i = 0; block.bends && i < block.count; ++i) {
    const PointLanes& point = points[i];
    const Lanes3 went_a = point.arm_a - point.pivot_a + point.normal_0 * point.radius_a,
                 went_b = point.arm_b - point.pivot_b - point.normal_0 * point.radius_b,
                 bent = point.normal - point.normal_0;
    way = larger(
        way, dot(went_a, went_a) + dot(went_b, went_b) + dot(bent, bent) * (block.reach_a + block.reach_b));
  }
  const auto far = way * block.slender > inAll(1);
  bool any = false;
  for (int lane = 0; lane < kLanes; ++lane) any = any || far[lane] != 0;
  return any;
}

void ContactRows::carryBlock(const Block& block, std::vector<BodyState>& states) {
  Lanes3 impulse, on_a, on_b;
  for (int i = block.begin; i < block.begin + block.count; ++i) {
    const PointLanes& point = points_[static_cast<std::size_t>(i)];
    const Lanes3 push =
        point.normal * point.impulse + point.side_1 * point.impulse_1 + point.side_2 * point.impulse_2;
    impulse = impulse + push;
    on_a = on_a + cross(point.arm_a, push);
    on_b = on_b + cross(point.arm_b, push);
    if (!block.rolls) continue;
    const Lanes3 turn = point.side_1 * point.roll_1 + point.side_2 * point.roll_2 + point.normal * point.spin;
    on_a = on_a + turn;
    on_b = on_b + turn;
  }
  LaneBodies::add(impulse, on_a, block.a, movable_, states);
  LaneBodies::add(impulse * inAll(-1), on_b * inAll(-1), block.b, movable_, states);
}

/// Points that the bodies reach leave as fast as restitution says. They meet within the substep: until then
/// they go on, and from there they go apart. Speeds are those of the middle of a substep: what forces add
/// until then, and from then on, counts as well, or each bounce would be a little higher than the last.
void ContactRows::findBounces(int index, const SolverBodies& bodies) {
  Block& block = blocks_[static_cast<std::size_t>(index)];
  if (!block.bounces) return;
  block.bouncing = false;
  const Lanes none{}, one = inAll(1), half = inAll(btScalar(0.5));
  const LaneBodies a(block.a, bodies.states()), b(block.b, bodies.states());
  Lanes3 falls;
  for (int lane = 0; lane < kLanes; ++lane)
    falls.set(lane, bodies.acceleration(block.b[lane]) - bodies.acceleration(block.a[lane]));
  for (int i = block.begin; i < block.begin + block.count; ++i) {
    PointLanes& point = points_[static_cast<std::size_t>(i)];
    const Lanes speed = dot(a.velocityAt(point.arm_a) - b.velocityAt(point.arm_b), point.normal);
    const auto hits = (point.gap + speed * inAll(substep_) <= none) & (speed < inAll(-bounce_threshold_));
    const Lanes closing = hits ? none - speed : one, pull = dot(falls, point.normal) * inAll(substep_);
    const Lanes until = larger(point.gap, none) / (closing * inAll(substep_)), after = one - until;
    const Lanes leaves = point.restitution * (closing + pull * (until - half));
    point.bounce = hits ? larger(leaves + pull * (until - half), none) : none;
    point.bounce_way = leaves * after - pull * after * after * half - closing * until;
    for (int lane = 0; lane < kLanes; ++lane) block.bouncing = block.bouncing || point.bounce[lane] > 0;
  }
}

void ContactRows::solveFriction(const Block& block, PointLanes& point, LaneBodies& a, LaneBodies& b) {
  const Lanes3 slide = a.velocityAt(point.arm_a) - b.velocityAt(point.arm_b);
  const Lanes slide_1 = dot(slide, point.side_1) - point.belt_1,
              slide_2 = dot(slide, point.side_2) - point.belt_2;
  const Lanes most = point.friction * point.impulse;
  Lanes along_1 = point.impulse_1 - point.mass_1 * slide_1;
  Lanes along_2 = point.impulse_2 - point.mass_2 * slide_2;
  // What slides is braked against its way, from which two masses would turn the impulse aside.
  const auto slides = along_1 * along_1 + along_2 * along_2 > most * most;
  // One way may be free of friction, and then that one has no mass.
  const Lanes mass = smaller(point.mass_1, point.mass_2) > Lanes{} ? smaller(point.mass_1, point.mass_2)
                                                                   : larger(point.mass_1, point.mass_2);
  along_1 = slides ? point.impulse_1 - mass * slide_1 : along_1;
  along_2 = slides ? point.impulse_2 - mass * slide_2 : along_2;
  holdWithin(most, along_1, along_2);
  const Lanes3 impulse =
      point.side_1 * (along_1 - point.impulse_1) + point.side_2 * (along_2 - point.impulse_2);
  point.impulse_1 = along_1;
  point.impulse_2 = along_2;
  a.pushAt(point.arm_a, impulse);
  b.pushAt(point.arm_b, impulse * inAll(-1));
  if (!block.rolls) return;
  const Lanes3 rolls = a.spin - b.spin;
  Lanes roll_1 = point.roll_1 - point.mass_rolling * dot(rolls, point.side_1);
  Lanes roll_2 = point.roll_2 - point.mass_rolling * dot(rolls, point.side_2);
  holdWithin(point.rolling * point.impulse, roll_1, roll_2);
  const Lanes most_spin = point.spinning * point.impulse;
  const Lanes spin = larger(smaller(point.spin - point.mass_spinning * dot(rolls, point.normal), most_spin),
                            most_spin * inAll(-1));
  const Lanes3 turn = point.side_1 * (roll_1 - point.roll_1) + point.side_2 * (roll_2 - point.roll_2) +
                      point.normal * (spin - point.spin);
  point.roll_1 = roll_1;
  point.roll_2 = roll_2;
  point.spin = spin;
  a.turn(turn);
  b.turn(turn * inAll(-1));
}

/// Tells `slowed` what it takes from a speed, unless that bounces. In passes that push, what is apart may
/// come as near as it is; passes that relax, when the bodies have got there, stop it.
void ContactRows::solveNormal(PointLanes& point, Pass pass, LaneBodies& a, LaneBodies& b,
                              Slowed& slowed) const {
  const Lanes none{}, one = inAll(1);
  const Lanes gap = point.gap;
  const Lanes speed = dot(a.velocityAt(point.arm_a) - b.velocityAt(point.arm_b), point.normal);
  const auto open = gap > none;
  const auto bounces = point.bounce > none;
  // Apart, they may come as near as they are; in each other, they are driven apart.
  Lanes bias = gap * inAll(1 / substep_), mass = one, give = none, acts = one;
  if (pass == Pass::push) {
    const Lanes wanted = gap * point.rate, driven = larger(wanted, point.fastest * inAll(-1));
    // No faster than that, but a load is borne as without that bound, or bodies would sink on under it.
    const Lanes borne = point.loaded * point.mass * point.soft_mass * (driven - wanted);
    bias = open ? bias : driven;
    mass = open ? one : point.soft_mass;
    give = open ? none : larger(point.soft_impulse * point.impulse - borne, none);
  } else {
    bias = open ? bias : none;
    acts = open ? one : one - point.spring;  // a spring of the user's is no error to be given back
  }
  // What has been thrown against the next body in this substep is to bounce off it in the next one.
  acts = speed * point.restitution < inAll(-bounce_threshold_) * point.restitution ? none : acts;
  bias = bounces ? none - (pass == Pass::push ? point.bounce_way : point.bounce) : bias;
  mass = bounces ? one : mass;
  give = bounces ? none : give;
  acts = bounces ? one : acts;
  const Lanes change = acts * (none - point.mass * mass * (speed + bias) - give);
  const Lanes total = larger(point.impulse + change, none);
  const Lanes added = total - point.impulse;
  const Lanes3 push = point.normal * added;
  point.impulse = total;
  a.pushAt(point.arm_a, push);
  b.pushAt(point.arm_b, push * inAll(-1));
  const Lanes taken = point.mass == none ? none : added / point.mass;
  slowed.now = larger(slowed.now, bounces ? none : taken);
  if (pass != Pass::push) return;
  const Lanes left = gap * inAll(1 / substep_) + speed + taken;  // where the substep ends, in substeps
  slowed.later = larger(slowed.later, open ? (left + speed + taken) * inAll(-1) : none);
}

void ContactRows::solveBlock(int index, Pass pass, std::vector<BodyState>& states) {
  Block& block = blocks_[static_cast<std::size_t>(index)];
  LaneBodies a(block.a, states), b(block.b, states);
  PointLanes* const begin = points_.data() + block.begin;
  PointLanes* const end = begin + block.count;
  if (pass != Pass::push) {
    for (PointLanes* point = begin; point != end; ++point) follow(block, *point, a, b);
    block.turned = block.turned || hasTurnedFar(block, begin, a, b);
    if (block.turned) renewMasses(index, states);
  }
  Slowed slowed{};
  for (int round = block.bouncing ? kBounceRounds : 1; round > 0; --round) {
    for (PointLanes* point = begin; point != end; ++point) {
      solveNormal(*point, pass, a, b, slowed);
      solveFriction(block, *point, a, b);
    }
  }
  a.put(block.a, movable_, states);
  b.put(block.b, movable_, states);
  if (pass != Pass::finish) {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (slowed.now[lane] > block.calm[lane]) impact_.store(true, std::memory_order_relaxed);
      if (slowed.later[lane] > block.calm[lane]) arrival_.store(true, std::memory_order_relaxed);
    }
    return;
  }
  for (PointLanes* point = begin; point != end; ++point) {
    point->sum += point->impulse;
    point->sum_1 += point->impulse_1;
    point->sum_2 += point->impulse_2;
    if (!block.bouncing) continue;
    // What threw bodies back is no load that goes on.
    const Lanes none{};
    const auto bounced = point->bounce > none;
    point->impulse = bounced ? none : point->impulse;
    point->impulse_1 = bounced ? none : point->impulse_1;
    point->impulse_2 = bounced ? none : point->impulse_2;
  }
  carryBlock(block, states);
}

void ContactRows::carryWide(int index, std::vector<BodyState>& states) {
  carryBlock(blocks_[static_cast<std::size_t>(index)], states);
}

void ContactRows::solveWide(int index, Pass pass, std::vector<BodyState>& states) {
  solveBlock(index, pass, states);
}

void ContactRows::carry(int index, std::vector<BodyState>& states) {
  wide_ ? carryWide(index, states) : carryBlock(blocks_[static_cast<std::size_t>(index)], states);
}

void ContactRows::solve(int index, Pass pass, std::vector<BodyState>& states) {
  wide_ ? solveWide(index, pass, states) : solveBlock(index, pass, states);
}

/// Manifolds without a dispatcher may share a place: that is the last one's.
void ContactRows::remember(const TouchingPair& pair, int lane, const PointLanes* points) {
  const btPersistentManifold* before = nullptr;
  for (int i = 0; i < pair.count; ++i) {
    const PointLanes& from = points[i];
    const Source& source = sources_[static_cast<std::size_t>(pair.begin + i)];
    const auto place = static_cast<std::size_t>(source.manifold->m_index1a);
    if (known_[place] != source.manifold) continue;
    if (source.manifold != before) turnings_[place].setZero();
    before = source.manifold;
    const btVector3 turning = from.side_1.get(lane) * from.roll_1[lane] +
                              from.side_2.get(lane) * from.roll_2[lane] +
                              from.normal.get(lane) * from.spin[lane];
    turnings_[place] += turning * (source.flipped ? btScalar(-1) : btScalar(1));
  }
}

void ContactRows::writeBack(int index) {
  const Block& block = blocks_[static_cast<std::size_t>(index)];
  for (int lane = 0; lane < kLanes; ++lane) {
    if (block.pair[lane] < 0) continue;
    const TouchingPair& pair = pairs_[static_cast<std::size_t>(block.pair[lane])];
    remember(pair, lane, points_.data() + block.begin);
    for (int i = 0; i < pair.count; ++i) {
      const PointLanes& from = points_[static_cast<std::size_t>(block.begin + i)];
      const Source& source = sources_[static_cast<std::size_t>(pair.begin + i)];
      btManifoldPoint& point = *source.point;
      point.m_appliedImpulse = from.sum[lane];
      point.m_prevRHS = from.impulse[lane] * from.kept[lane] * substeps_;
      point.m_appliedImpulseLateral1 = from.sum_1[lane];
      point.m_appliedImpulseLateral2 = from.sum_2[lane];
      if ((point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) != 0) continue;
      const btScalar sign = source.flipped ? btScalar(-1) : btScalar(1);
      point.m_lateralFrictionDir1 = from.side_1.get(lane) * sign;
      point.m_lateralFrictionDir2 = from.side_2.get(lane) * sign;
    }
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
