// Finds the deepest points between curved surfaces.
#pragma once

#include <optional>
#include <vector>

#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/surface_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Says which spheres lines may start from, all over the contact.
class LineStarts {
 public:
  struct Start {
    btVector3 at;
    btScalar reach;
  };
  /// `room` is to work in.
  LineStarts(const SurfaceProbe& surfaces, const std::vector<std::size_t>& spheres, std::vector<Start>& room)
      : probe(surfaces), spheres_(spheres), room_(room) {
    room_.clear();
  }

  /// Returns the sphere that has most to spare for a line through `place`; nothing if all are out of reach.
  std::optional<std::size_t> nearest(const btVector3& place, const btVector3& direction) const;

  const SurfaceProbe& probe;

 private:
  const std::vector<std::size_t>& spheres_;
  std::vector<Start>& room_;  ///< of the spheres, once one was looked for
};

/// The top of a hill of the depth.
struct Top {
  ProbedSample sample;
  Hill hill;
};

/// Replaces `tops` by those that ascents from the deepest points among `before` reach, which have been
/// carried to where the bodies are now. A hill of tessellated surfaces has several tops close to each other,
/// and bodies would never come to rest between them: the one that was found before is found again.
void ascendAgain(const LineStarts& lines, btScalar separation, const std::vector<ContactPoint>& before,
                 std::vector<Top>& tops);

/// Spheres sample a contact at places of their own. Where curved solids touch, the points that bear lie
/// between them: beside them a rolling body would brake, and one that lies on two hills would rock from one
/// to the other. Appends the tops of the four deepest hills of the depth, with ids of their own, as far as
/// they come within `separation` [m]. Marks the samples from which an ascent to one of them began. No ascent
/// leads to the `known` tops, of which the first `of_patch` are among those that are appended.
void appendDeepestPoints(const LineStarts& lines, btScalar separation, const std::vector<Top>& known,
                         std::size_t of_patch, std::vector<ProbedSample>& samples);

/// Returns true if a place at `from_top` [m] from the top of a hill lies on that hill: if the slope there
/// leads to this top, or it is nearer to it than a part of `separation` [m].
bool isOnHill(const btVector3& from_top, const btVector3& slope, const Hill& hill, btScalar separation);

/// Moves the first `count` samples a little uphill where they are near a top.
void ascendBeside(const LineStarts& lines, std::size_t count, std::vector<ProbedSample>& samples);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
