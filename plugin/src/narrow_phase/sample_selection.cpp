#include "narrow_phase/sample_selection.hpp"

#include <algorithm>
#include <array>

#include "common/bullet_vectors.hpp"
#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

bool isOld(const PatchContacts& from, std::uint64_t id) {
  return std::find(from.old_ids.begin(), from.old_ids.end(), id) != from.old_ids.end();
}

struct Furthest {
  std::size_t index = 0;
  btScalar distance = -BT_LARGE_FLOAT;

  void update(std::size_t i, btScalar d) {
    if (d > distance) *this = {i, d};
  }
};

void pickOld(const PatchContacts& from, std::vector<std::size_t>& picked) {
  for (std::size_t i : from.indices) {
    if (isOld(from, from.spheres.id(i))) picked.push_back(i);
  }
}

/// Those that span the patch.
void pickOutermost(const PatchContacts& from, std::vector<std::size_t>& picked) {
  std::array<btVector3, kOutermostDirections> directions;
  for (int k = 0; k < kOutermostDirections; ++k) {
    const btScalar angle = btScalar(k) * SIMD_2_PI / kOutermostDirections;
    directions[k] = from.moments.tangent[0] * btCos(angle) + from.moments.tangent[1] * btSin(angle);
  }
  std::array<Furthest, kOutermostDirections> furthest;
  for (std::size_t i : from.indices) {
    const btVector3 centroid = toBullet(from.contacts[i].centroid);
    for (int k = 0; k < kOutermostDirections; ++k) furthest[k].update(i, directions[k].dot(centroid));
  }
  for (const Furthest& f : furthest) picked.push_back(f.index);
}

void pickEvenlySpaced(const PatchContacts& from, std::vector<std::size_t>& picked) {
  for (std::size_t k = 0; k < kEvenlySpaced; ++k)
    picked.push_back(from.indices[k * from.indices.size() / kEvenlySpaced]);
}

/// The eighth of the plane that a place is in, in any order.
std::size_t sectorOf(btScalar u, btScalar v) {
  return (u < 0 ? 1 : 0) + (v < 0 ? 2 : 0) + (btFabs(u) < btFabs(v) ? 4 : 0);
}

/// Where solids are bumpy, a corner or a foot stands out, and small spheres in it.
void pickProtruding(const PatchContacts& from, std::vector<std::size_t>& picked) {
  std::array<Furthest, 2 * kSectors> furthest;
  for (std::size_t i : from.indices) {
    const btVector3 side = toBullet(from.contacts[i].centroid) - from.moments.centre;
    const std::size_t sector = sectorOf(side.dot(from.moments.tangent[0]), side.dot(from.moments.tangent[1]));
    const ContactSpheres::Protrusion protrusion = from.spheres.protrusion(i, from.moments.normal);
    furthest[2 * sector + (protrusion.of_a ? 0 : 1)].update(i, protrusion.distance);
  }
  for (const Furthest& f : furthest) {
    if (f.distance > -BT_LARGE_FLOAT) picked.push_back(f.index);
  }
}

/// Those whose area faces the normal of the patch most. `sorted` is room to sort them in.
void pickMostFacing(const PatchContacts& from, std::vector<std::size_t>& sorted,
                    std::vector<std::size_t>& picked) {
  const auto facing = [&](std::size_t i) { return from.moments.normal.dot(toBullet(from.contacts[i].area)); };
  sorted = from.indices;
  std::partial_sort(sorted.begin(), sorted.begin() + kMostFacing, sorted.end(),
                    [&](std::size_t i, std::size_t j) { return facing(i) > facing(j); });
  picked.insert(picked.end(), sorted.begin(), sorted.begin() + kMostFacing);
}

void append(const std::vector<std::size_t>& indices, const PatchMoments& moments, Samples& samples) {
  samples.indices.insert(samples.indices.end(), indices.begin(), indices.end());
  samples.patches.push_back({moments.normal, moments.area, moments.radius, samples.indices.size()});
}

}  // namespace

void turn(const btMatrix3x3& by, Samples& samples) {
  for (Samples::OfPatch& patch : samples.patches) patch.normal = by * patch.normal;
  for (Samples::Line& line : samples.lines) line.direction = by * line.direction;
}

void dropUnprobed(Samples& samples) {
  std::size_t kept = 0, k = 0;
  for (Samples::OfPatch& patch : samples.patches) {
    for (; k < patch.end; ++k) {
      if (samples.lines[k].direction.isZero()) continue;
      samples.indices[kept] = samples.indices[k];
      samples.lines[kept++] = samples.lines[k];
    }
    patch.end = kept;
  }
  samples.indices.resize(kept);
  samples.lines.resize(kept);
}

void dropShallow(const std::vector<btScalar>& depths, btScalar spacing, btScalar needed, btScalar inset,
                 std::vector<std::size_t>& indices) {
  btScalar deepest = -BT_LARGE_FLOAT;
  for (std::size_t i : indices) deepest = btMax(deepest, depths[i]);
  const btScalar least = btMin(deepest - kLessDeep * spacing - needed - inset, btScalar(0));
  indices.erase(
      std::remove_if(indices.begin(), indices.end(), [&](std::size_t i) { return depths[i] < least; }),
      indices.end());
}

void appendSamples(const PatchContacts& from, SelectionScratch& scratch, Samples& samples) {
  if (from.indices.size() <= kOutermostDirections + kMostFacing + kEvenlySpaced)
    return append(from.indices, from.moments, samples);
  std::vector<std::size_t>& picked = scratch.picked;
  picked.clear();
  pickOld(from, picked);
  pickOutermost(from, picked);
  pickEvenlySpaced(from, picked);
  pickProtruding(from, picked);
  pickMostFacing(from, scratch.indices, picked);
  std::sort(picked.begin(), picked.end());
  picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
  append(picked, from.moments, samples);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
