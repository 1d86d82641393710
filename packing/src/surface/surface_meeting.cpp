#include "surface/surface_meeting.hpp"

#include <algorithm>
#include <array>

#include "surface/box_search.hpp"
#include "surface/kernels.hpp"

namespace innersphere {

namespace {

using Index = GridSurface::Index;

/// Says which edge crosses the plane of a triangle of the other surface.
struct Crosser {
  GridSurface* surface;
  GridSurface::Triangle* triangle;
  const GridTriangle* plane;
  int edge;
  bool rises;

  Crosser(GridSurface& of, GridSurface::Triangle& t, const GridTriangle& other, const Corners& corners,
          bool from_alone)
      : surface(&of),
        triangle(&t),
        plane(&other),
        edge(corners.edge(from_alone)),
        rises(corners.isAbove(edge)) {}
  /// Both triangles at an edge find the same place: from the lower vertex.
  bool isForward() const { return triangle->vertices[edge] < triangle->vertices[Corners::next(edge)]; }
  const double* from() const { return triangle->places[0] + edge + static_cast<int>(!isForward()); }
  const double* to() const { return triangle->places[0] + edge + static_cast<int>(isForward()); }
};

/// Adds where two edges cross. Returns both places.
std::array<Vec3d, 2> addCrossings(const Crosser& first, const Crosser& second) {
  const auto both = [](const double* x, const double* y, int axis) {
    return TwoDoubles{x[GridTriangle::kRow * axis], y[GridTriangle::kRow * axis]};
  };
  const double *from_1 = first.from(), *from_2 = second.from(), *to_1 = first.to(), *to_2 = second.to();
  const TwoDoubles from[3] = {both(from_1, from_2, 0), both(from_1, from_2, 1), both(from_1, from_2, 2)};
  const TwoDoubles to[3] = {both(to_1, to_2, 0), both(to_1, to_2, 1), both(to_1, to_2, 2)};
  const Vec3d &n1 = first.plane->normal, &n2 = second.plane->normal;
  const TwoDoubles x{n1.x, n2.x}, y{n1.y, n2.y}, z{n1.z, n2.z},
      offset{first.plane->offset, second.plane->offset};
  const TwoDoubles height = x * from[0] + y * from[1] + z * from[2] - offset;
  const TwoDoubles fall = height - (x * to[0] + y * to[1] + z * to[2] - offset);
  const TwoDoubles half{0.5, 0.5}, zero{}, one{1, 1};
  TwoDoubles part = height / fall;
  part = part < zero ? zero : part;
  part = part > one ? one : part;
  part = fall != zero ? part : half;
  std::array<Vec3d, 2> places;
  for (int axis = 0; axis < 3; ++axis) {
    const TwoDoubles at = from[axis] + part * (to[axis] - from[axis]);
    places[0][axis] = at[0];
    places[1][axis] = at[1];
  }
  first.surface->addCrossing(*first.triangle, places[0], first.edge, first.rises ? 1 : -1);
  second.surface->addCrossing(*second.triangle, places[1], second.edge, second.rises ? 1 : -1);
  return places;
}

/// Holds two triangles, and how they lie to each other.
struct Candidate {
  Index t, u;  ///< where they are in A and B
  Corners at_t, at_u;
  EdgeOrder order;

  // Two edges of each cross the line. In the direction normal of t x normal of u one is the first: that from
  // the corner that is alone, or that to it.
  bool firstOfT() const { return !at_u.isAbove(at_u.alone); }
  bool firstOfU() const { return at_t.isAbove(at_t.alone); }
};

/// Sorts out pairs in steps, each of which goes through all that are left. What is kept is written over what
/// is not, for no processor foresees which that is.
template <class Kernels>
class Meeting {
 public:
  Meeting(GridSurface& a, GridSurface& b) : a_(a), b_(b) {}
  void find(Pairs& pairs, std::vector<Candidate>& candidates);

 private:
  static void dropRepeated(Pairs& pairs);
  void keepCrossing(const Pairs& pairs, std::vector<Candidate>& candidates);
  void keepMeeting(std::vector<Candidate>& candidates);
  void add(const Candidate& c);

  GridSurface &a_, &b_;
  std::size_t count_ = 0;  ///< of candidates
};

/// Drops most of the pairs that were there before.
template <class Kernels>
void Meeting<Kernels>::dropRepeated(Pairs& pairs) {
  constexpr std::size_t kRecent = 256;
  std::array<std::array<Index, 2>, kRecent> recent;
  recent.fill({GridSurface::kNone, GridSurface::kNone});
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.count; ++i) {
    const std::array<Index, 2> pair{pairs.a[i], pairs.b[i]};
    std::array<Index, 2>& before = recent[(31 * pair[0] + pair[1]) % kRecent];
    pairs.a[kept] = pair[0];
    pairs.b[kept] = pair[1];
    kept += ((before[0] ^ pair[0]) | (before[1] ^ pair[1])) != 0 ? 1 : 0;
    before = pair;
  }
  pairs.count = kept;
}

/// Keeps those of which each has corners on both sides of the other one's plane.
template <class Kernels>
void Meeting<Kernels>::keepCrossing(const Pairs& pairs, std::vector<Candidate>& candidates) {
  if (candidates.size() < pairs.count + 1) candidates.resize(2 * pairs.count + 1);
  for (std::size_t i = 0; i < pairs.count; ++i) {
    Candidate& c = candidates[count_];
    c.t = a_.find(pairs.a[i]);
    c.u = b_.find(pairs.b[i]);
    const GridTriangle &t = a_.at(c.t), &u = b_.at(c.u);
    c.at_t = cornersAt<Kernels>(t, u, Moved::point);
    c.at_u = cornersAt<Kernels>(u, t, Moved::triangle);
    count_ += (c.at_t.alone | c.at_u.alone) >= 0 ? 1 : 0;
  }
}

/// Keeps those that have a part of the line in common in which their planes meet.
template <class Kernels>
void Meeting<Kernels>::keepMeeting(std::vector<Candidate>& candidates) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Candidate& c = candidates[i];
    const Index t = c.t, u = c.u;
    const Corners at_t = c.at_t, at_u = c.at_u;
    const bool first_t = c.firstOfT(), first_u = c.firstOfU();
    const EdgeOrder order = EdgeOrder::of<Kernels>(a_.at(t), at_u, b_.at(u), at_t);
    // Not copied as a whole: that would wait for its bytes.
    Candidate& to = candidates[kept];
    to.t = t;
    to.u = u;
    to.at_t = at_t;
    to.at_u = at_u;
    to.order = order;
    const int starts = order.comesBefore(first_t, !first_u), is_over = order.comesBefore(!first_t, first_u);
    kept += static_cast<std::size_t>(starts & ~is_over);
  }
  count_ = kept;
}

/// Adds the segment that two triangles have in common.
template <class Kernels>
void Meeting<Kernels>::add(const Candidate& c) {
  GridSurface::Triangle &t = a_.at(c.t), &u = b_.at(c.u);
  // Several of their boxes may meet, but they do once.
  for (Index s = t.first_segment; s != GridSurface::kNone; s = a_.segments()[s].next) {
    if (a_.segments()[s].other == c.u) return;
  }
  const bool first_t = c.firstOfT(), first_u = c.firstOfU();
  // Chosen by number: no processor foresees which edges they are.
  GridSurface* const surfaces[] = {&a_, &b_};
  GridSurface::Triangle* const triangles[] = {&t, &u};
  const Corners at[] = {c.at_u, c.at_t};
  const bool from_alone[] = {first_t, first_u};
  const auto crosser = [&](int of, bool is_start) {
    return Crosser(*surfaces[of], *triangles[of], *triangles[1 - of], at[of], from_alone[of] == is_start);
  };
  const int start = static_cast<int>(c.order.comesBefore(first_t, first_u)),
            end = static_cast<int>(!c.order.comesBefore(!first_t, !first_u));
  const auto [from, to] = addCrossings(crosser(start, true), crosser(end, false));
  a_.addSegment(t, from, to, c.u);
  b_.addSegment(u, to, from, c.t);
}

template <class Kernels>
void Meeting<Kernels>::find(Pairs& pairs, std::vector<Candidate>& candidates) {
  dropRepeated(pairs);
  keepCrossing(pairs, candidates);
  keepMeeting(candidates);
  for (std::size_t i = 0; i < count_; ++i) add(candidates[i]);
}

#ifdef INNERSPHERE_AVX512_SURFACE
INNERSPHERE_AVX512_SURFACE void findAvx512(GridSurface& a, GridSurface& b, Pairs& pairs,
                                           std::vector<Candidate>& candidates) {
  Meeting<Avx512Kernels>(a, b).find(pairs, candidates);
}
#endif

}  // namespace

void findMeeting(GridSurface& a, GridSurface& b) {
  static thread_local Pairs pairs_of_thread;
  static thread_local std::vector<Candidate> candidates_of_thread;
  Pairs& pairs = here(pairs_of_thread);
  std::vector<Candidate>& candidates = here(candidates_of_thread);
  findPairs(a, b, pairs);
#ifdef INNERSPHERE_AVX512_SURFACE
  if (a.isWide()) return findAvx512(a, b, pairs, candidates);
#endif
  Meeting<AnyKernels>(a, b).find(pairs, candidates);
}

}  // namespace innersphere
