// Holds the tuned numbers of the contact geometry, each with its unit and its reason.
//
// Cosines compare unit vectors: a larger cosine asks for a smaller angle. Numbers in spheres, spacings,
// separations or lengths are fractions of that length, so that nothing depends on the size of a solid.
#pragma once

#include <cstddef>

#include <LinearMath/btScalar.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

// --- Surfaces along a line -------------------------------------------------------------------------------

/// Cosine, 60 degrees: a surface that a line meets at a flatter angle is the side of the solid, not the face
/// in contact.
constexpr btScalar kFrontCosine = btScalar(0.5);
/// Cosine, 5 degrees: normals that are closer belong to one flat face.
constexpr btScalar kSameFaceCosine = btScalar(0.996);
/// Cosine, 15 degrees: normals that are closer belong to one face that bends. A corner may be over it some
/// way from where it was probed.
constexpr btScalar kSameBentFaceCosine = btScalar(0.966);
/// In spheres: from a place this deep under a face the direction to the face is well defined.
constexpr btScalar kSunk = btScalar(0.1);
/// In search radii: the height above a face at which its continuation is looked for.
constexpr btScalar kAboveFace = btScalar(0.03);
/// In search radii: a place that is this much further away than its height is beyond the edge of the face.
constexpr btScalar kBeyondFace = btScalar(0.01);

// --- Probing of samples ----------------------------------------------------------------------------------

/// Cosine, 60 degrees: the nearest point of the other surface counts if it lies this close to the direction
/// of the patch; a sphere that sees another side of the solid would pull the contact around the corner.
constexpr btScalar kPatchCosine = btScalar(0.5);
/// Cosine, 5 degrees: where flat faces meet a line this close to the normal is not drawn again, as the depth
/// along it is the same.
constexpr btScalar kAlignedOnFacesCosine = btScalar(0.996);
/// Cosine, 0.5 degrees: elsewhere a line has to be this close to the normal. Normals this close are parallel.
constexpr btScalar kParallelCosine = btScalar(0.99996);
/// [rad]: a face that leans more does not lie flat on the other, so that one of its corners is deeper.
constexpr btScalar kLeaning = btScalar(1e-3);

// --- Directions of contact -------------------------------------------------------------------------------

/// Cosine, 20 degrees: surfaces whose normals are closer lie on each other. Otherwise an edge or a corner
/// lies on a face.
constexpr btScalar kOpposedCosine = btScalar(0.94);
/// Cosine, 30 degrees: where both surfaces bend, a face bears an edge if its normal is this close to the line
/// that was probed.
constexpr btScalar kBearingFaceCosine = btScalar(0.866);
/// Ratio: an edge is taken to bend this much more than what is round on it, and, in inverse sizes of the
/// smaller body, no more. Ten times as much is lost to rounding in single precision.
constexpr btScalar kEdgeSharpness = 1000;
/// In inverse sizes of the smaller body: what bends less against each other lies flat, and does not roll. A
/// milliradian would take the place across all of the body. What is less by far is rounding.
constexpr btScalar kFlatTogether = btScalar(1e-3);
/// Ratio: where one of two surfaces bends this much more than the other, it is an edge.
constexpr btScalar kEdgeBends = 10;
/// Ratio: a face that ends this much sooner than the other one has its edge on the other.
constexpr btScalar kEndsSooner = btScalar(0.5);
/// [rad]: normals whose root mean square deviation is less are those of one flat face, but for rounding.
constexpr btScalar kOneNormal = btScalar(1e-3);

// --- Deepest points --------------------------------------------------------------------------------------

/// Cosine, 60 degrees: a surface that leans more from the line has no usable slope.
constexpr btScalar kUsableCosine = btScalar(0.5);
/// Ratio: a hollow surface that is convex along its other axis by less than this part is straight there, but
/// for its triangles.
constexpr btScalar kConvex = btScalar(0.01);
/// An ascent to a top takes so many steps at most: each is one of Newton's method, whose error falls
/// quadratically.
constexpr int kAscentSteps = 8;
/// Where the other surface has edges, each is one of a search in brackets: their number falls to a half or a
/// third.
constexpr int kAscentStepsOverEdges = 16;
/// The other samples, which only have to get nearer, take so many.
constexpr int kAscentStepsBeside = 2;
/// Ratio: the slope is not believed to fall more slowly than by this part of what was believed before.
constexpr btScalar kSlowestFall = btScalar(0.02);
/// Ratio: a step that did not lead uphill is taken again, shorter by this.
constexpr btScalar kShorter = 3;
/// Ratio: a step leads uphill if it gains this part of what the slope at its start promises. On a paraboloid
/// it gains a half.
constexpr btScalar kClimbs = btScalar(0.25);
/// Ratio: what is this part as deep below a face as along it has sunk in from that face.
constexpr btScalar kSliver = btScalar(0.1);
/// Ratio: a step that gains so many times what the slope promised, and more than the facets of a mesh may
/// lean on the way (as those of a tube of twelve sides), has met another wall.
constexpr btScalar kLeaps = 2, kFacets = btScalar(0.25);
/// Ratio: a step over edges that loses this part of what the slope promised leads down another facet, however
/// flat that is. Less may be rounding.
constexpr btScalar kSinks = btScalar(0.02);
/// [rad]: where the slope is less, the top is reached: the normals are that close.
constexpr btScalar kLevel = btScalar(1e-5);
/// [rad]: an ascent that ends where the slope is less has reached its top.
constexpr btScalar kReached = btScalar(1e-3);
/// [rad]: other samples ascend where the slope is less. These are the places that a rolling body meets next.
constexpr btScalar kSlopeBeside = btScalar(0.1);
/// [rad]: a slope that is steeper says little about the top.
constexpr btScalar kSteepSlope = btScalar(0.5);
/// In ways to a top: a top that is guessed this near to one that was reached is that one.
constexpr btScalar kSameHill = btScalar(0.5);
/// In separations: a top that is guessed this near to one that was reached is that one, too, however short
/// the way to it.
constexpr btScalar kSameTop = btScalar(0.1);

// --- Crossing edges --------------------------------------------------------------------------------------

/// Edges are looked for at most so often, each time where those before would cross.
constexpr int kEdgeLooks = 4;
/// Sine, 5 degrees: edges that are closer to parallel do not cross at a place.
constexpr btScalar kCrossingSine = btScalar(0.087);
/// Sine, 5 degrees: faces that fall away from their edge by less are in contact themselves.
constexpr btScalar kFallingSine = btScalar(0.087);
/// In lengths of the edge: edges still cross this far beyond their ends, so that rounding leaves no gap.
constexpr btScalar kBeyondEnds = btScalar(1e-4);
/// In ways to the middle of the triangle: a place on an edge does not show what is met along the edge, so the
/// look for edges starts this far inside.
constexpr btScalar kStartInside = btScalar(0.01);
/// In lengths of the shorter edge: edges that are less deep in each other are near each other for sure.
constexpr btScalar kShallow = btScalar(0.01);

// --- Outlines of faces that lie on each other --------------------------------------------------------------

/// Outlines of one patch have so many sides at most: rounder ones have corners enough.
constexpr int kOverlapSides = 32;
/// In rounding of both surfaces: the walk along an edge is this far inside of it.
constexpr btScalar kWalkInside = 16;

// --- Selection of samples --------------------------------------------------------------------------------

/// This is the number of directions in which the outermost spheres of a patch are samples: an octagon spans
/// what the patch spans.
constexpr int kOutermostDirections = 8;
/// This is the number of sectors of the patch in which the spheres that stand out most of each solid are
/// samples.
constexpr std::size_t kSectors = 8;
/// This is how many of the spheres that face the other solid most are samples.
constexpr std::size_t kMostFacing = 6;
/// This is how many others are samples, evenly spaced in the list.
constexpr std::size_t kEvenlySpaced = 6;
/// In spacings: a sphere that does not overlap, and is this much less deep than the deepest, is not worth a
/// probe.
constexpr btScalar kLessDeep = 2;

// --- Passing ---------------------------------------------------------------------------------------------

/// In sizes of the smaller body: what would be met by less than this beside an edge is passed.
constexpr btScalar kGrazing = btScalar(1e-3);
/// In depths at rest: the same, of what is so small, or steps so long, that it lies deeper.
constexpr btScalar kGrazingAtRest = 2;
/// Cosine, 60 degrees: a nearest way out of a face that is closer to its normal is not beside its edge.
constexpr btScalar kBesideCosine = btScalar(0.5);
/// In steps: contacts are carried along into the next one.
constexpr btScalar kPassingSteps = 2;

// --- Manifold reduction ----------------------------------------------------------------------------------

/// Ratio: a point of the step before is kept until another one spans this much more.
constexpr btScalar kKeepSpan = btScalar(1.3);
/// In spacings: a point of the step before is kept until another one is this much deeper.
constexpr btScalar kKeepDepth = btScalar(1e-3);
/// In the depth above: a point at the rim of the patch may lack this much, as flat faces are as deep
/// everywhere.
constexpr btScalar kPreferRim = btScalar(0.5);
/// In spacings: a point that is less deep than the deepest by this much is worth 1/e of it.
constexpr btScalar kWorthFalls = btScalar(0.1);
/// In sizes of the smaller body: where curved bodies are deeper in each other, the sides of their hill bear,
/// too. That is twice the depth at which springs have become twice as stiff: under such loads the top alone,
/// which a step takes as fixed while bodies turn under it, lets chains swing up.
constexpr btScalar kSunkIn = btScalar(0.004);
/// The same where bodies touch on one hill only, of how deep the step alone would drive them. Sides that bear
/// now and then, as those of links that sink in by as much at rest, rock a chain.
constexpr btScalar kDrivenIn = btScalar(0.03);
/// Cosine, 15 degrees: points whose normals are closer to that of the deepest share its manifold.
constexpr btScalar kSameManifoldCosine = btScalar(0.966);
/// More manifolds of one pair than this are merged.
constexpr std::size_t kMaxManifolds = 8;
/// In depths: edges have sunk into each other this far around their crossing.
constexpr btScalar kSunkAround = 3;

// --- Patches by volume -------------------------------------------------------------------------------------

/// Determinant of the spread of a patch over the square of its trace: a thinner patch shows no slope across
/// it.
constexpr btScalar kThinPatch = btScalar(1e-4);

// --- Shapes that are no packings -------------------------------------------------------------------------

/// In search radii: a place that lacks no more than this is the outermost of a shape, for rounding.
constexpr btScalar kOutermostTolerance = btScalar(1e-3);
/// Cosine, 30 degrees: directions in which one sphere meets a mesh that are closer are one contact.
constexpr btScalar kSameDirectionCosine = btScalar(0.866);
/// In median radii: nearest points of triangles that are closer are the same place of a mesh.
constexpr btScalar kSamePlace = btScalar(1e-4);
/// In sizes of the contact: the triangles of a mesh are kept this far around it for the next steps.
constexpr btScalar kKeptAround = btScalar(0.1);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
