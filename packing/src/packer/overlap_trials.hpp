// Places copies of a solid so that they share given parts of it, cuts it by planes and puts balls inside it,
// and tells exactly how much they share.
#pragma once

#include <cstddef>
#include <vector>

#include "innersphere/packing.hpp"
#include "packer/container.hpp"
#include "packer/surface_samples.hpp"
#include "packer/voxels.hpp"

namespace innersphere {

/// Says where a copy is, and which part of the solid both share.
struct OverlapTrial {
  Pose pose;
  Voxels::Shared truth;
};

/// Says which part of the solid a plane cuts off: where `normal` x is less than `height`.
struct PlaneCut {
  Point normal;
  double height, truth;
};

/// Holds copies at poses that are the same for every run, by rising depth, planes, and balls inside.
struct OverlapTrials {
  std::vector<OverlapTrial> trials;
  std::vector<OverlapTrial> deep;
  std::vector<PlaneCut> planes;
  std::vector<Ball> inside;
  double shallowest = 0;  ///< See OverlapErrors::shallowest.
};

/// Places `count` copies. Of each three one is turned at random, with a random point of it on one of the
/// solid, one lies upon the solid but for some degrees, and one has a face flat on a face. Each moves until
/// it is as deep as wanted: the logarithms of volumes are evenly spread. `deep` more are turned or moved a
/// little from where they lie upon the solid, or both, and share more than kDeepOverlap of it. What all share
/// is found from `surface`, in the packing's frame, if it is closed and has the solid's volume; more than 1 %
/// of the solid is found from sample points if it has another, and all if it is open: from few for the deep
/// ones. If it is closed, there are a third as many planes through random points of the solid. As many balls
/// are about random points of it, from a tenth to all as large as fits there. `samples` are
/// points of the surface; without any no face lies on a face. `volume` is the solid's, in units of the unit
/// cube. Runs in the current TBB arena.
OverlapTrials makeOverlapTrials(const Container& container, const Surface& surface,
                                const SurfaceSamples& samples, double volume, std::size_t count,
                                std::size_t deep);

}  // namespace innersphere
