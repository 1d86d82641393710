// Turns what was probed in one patch into points of contact.
#pragma once

#include "narrow_phase/contact_samples.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Appends the points of one patch to those that were found in others. All that it takes must outlive it.
class PatchContactPoints {
 public:
  PatchContactPoints(const EdgeProbe& probe, const SurfaceProbe& surfaces, const Samples::OfPatch& patch,
                     const ContactReach& reach, SampleScratch& scratch, std::vector<WeightedPoint>& found);

  /// Appends the points that a sample leads to. `normal` is that of the contact there.
  void addSample(const ProbedSample& sample, const btVector3& normal);
  /// Does the same for a sample whose line leaves A by its side: an edge or a corner of A beside it bears.
  void addBeside(const ProbedSample& sample);
  /// And for one where A is through a mesh.
  void addTips(const ShapeProbe& probe, const ProbedSample& sample);
  /// Ends the patch: each point stands for an equal part of it.
  void shareOutArea();

 private:
  using Kind = WeightedPoint::Kind;
  using FaceEnd = EdgeProbe::FaceEnd;

  /// Returns true if a point has an id, and about this normal if there is one.
  bool isFound(std::uint64_t id, const btVector3* normal = nullptr) const;
  bool add(const OpposedPoints& points, const btVector3& normal, std::uint64_t id, Kind kind);
  bool findCorners(const ProbedSample& sample, const btVector3& normal, bool rises_a, bool rises_b);
  bool addCorner(const EdgeContact& corner, bool of_a);
  void addLineEnds(const OpposedPoints& points);
  bool addCrossing(const OpposedPoints& points, EdgeContact& crossing);
  void addOverlap(const OpposedPoints& points, const btVector3& normal);
  bool addEdge(const OpposedPoints& points, bool of_a, const btVector3& normal);
  bool addPeaks(const ProbedSample& sample, bool of_a);
  void addEnds(const ProbedSample& sample, const btVector3& normal);
  FaceEnd addOverEdge(const ProbedSample& sample, btVector3& to_top);
  bool addFace(const ProbedSample& sample, const btVector3& normal);
  bool keepInHollow(const OpposedPoints& points, WeightedPoint& point);
  void layOnHill(const EdgeContact& corner, bool of_a, WeightedPoint& point);
  void layOnHill(const OpposedPoints& points, const Across& axes, const SurfaceProbe::Bends& bends,
                 bool has_crest, WeightedPoint& point);
  void goToCrest(const OpposedPoints& points, const Across& axes, WeightedPoint& point);

  const EdgeProbe& probe_;
  const SurfaceProbe& surfaces_;
  const Samples::OfPatch& patch_;
  const ContactReach reach_;
  SampleScratch& scratch_;
  std::vector<WeightedPoint>& found_;
  const std::size_t first_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
