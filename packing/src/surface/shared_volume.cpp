#include "surface/shared_volume.hpp"

#include <algorithm>
#include <cmath>

#include "surface/box.hpp"
#include "surface/enclosed_surface.hpp"
#include "surface/surface_meeting.hpp"

namespace innersphere {

namespace {

/// Less than this, relative to the sum of absolute values, is what rounding leaves of no volume at all.
constexpr double kRounding = 1e-12;

/// Returns a box around one that is turned and moved.
Bounds placed(const Bounds& box, const Similarity& place) {
  Bounds result{place.translation, place.translation};
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) {
      const double m = place.matrix.m[3 * k + i];
      result.min[k] += std::min(m * box.min[i], m * box.max[i]);
      result.max[k] += std::max(m * box.min[i], m * box.max[i]);
    }
  }
  return result;
}

}  // namespace

SharedSums sharedVolume(const PlacedSurface& a, const PlacedSurface& b, bool wide) {
  // All is done in the frame of A.
  const Similarity identity{{{1, 0, 0, 0, 1, 0, 0, 0, 1}}, {0, 0, 0}};
  const Similarity b_to_a = after(a.place.inverse(), b.place);
  const Bounds &box_a = a.tree.bounds(), box_b = placed(b.tree.bounds(), b_to_a);
  if (isEmpty(common(box_a, box_b))) return {};
  const double reach = std::max(largest(box_a), largest(box_b));
  if (!(reach > 0)) return {};
  const double cells = std::exp2(kGridBits - 1 - std::ilogb(reach));
  static thread_local GridSurface a_of_thread, b_of_thread;
  GridSurface &on_grid_a = here(a_of_thread), &on_grid_b = here(b_of_thread);
  on_grid_a.begin(a.tree, b.tree, identity, b_to_a.inverse(), cells, Moved::point, wide);
  on_grid_b.begin(b.tree, a.tree, b_to_a, b_to_a, cells, Moved::triangle, wide);
  findMeeting(on_grid_a, on_grid_b);

  const std::vector<Segment>& meeting = on_grid_a.segments();
  const Vec3d origin = meeting.empty() ? on_grid_b.vertex(0) : meeting.front().from;
  const EnclosedSums of_a = sumEnclosed(on_grid_a, on_grid_b, origin, true),
                     of_b = sumEnclosed(on_grid_b, on_grid_a, origin, false);
  const double volume = of_a.volume + of_b.volume;
  if (!(volume > kRounding * (of_a.magnitude + of_b.magnitude))) return {};

  // Out of the grid, and of the frame of A.
  const double cell = a.place.scale() / cells;
  const core::Mat3<double> turn = core::scaled(a.place.matrix, 1 / a.place.scale());
  const Vec3d at = a.place((1 / cells) * origin);
  SharedSums sums;
  sums.volume = cell * cell * cell / 6 * volume;
  sums.moment = cell * cell * cell * cell / 24 * (turn * (of_a.moment + of_b.moment)) + sums.volume * at;
  sums.area = cell * cell / 2 * (turn * of_b.area);
  sums.turning = cell * cell * cell / 6 * (turn * of_b.turning) + cross(at, sums.area);
  sums.wetted = cell * cell / 2 * of_b.wetted;
  sums.pairs = meeting.size();
  return sums;
}

}  // namespace innersphere
