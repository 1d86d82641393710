#include "narrow_phase/sample_selection.hpp"

#include <algorithm>
#include <array>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Directions in which the outermost contacts of a patch are measured, sectors in which those that stand out
/// most of each solid are, and how many of the most facing and of the others.
constexpr int kDirections = 8;
constexpr std::size_t kSectors = 8;
constexpr std::size_t kFacing = 6;
constexpr std::size_t kOthers = 6;
/// In units of the spacing: how much less deep than the deepest a contact may be.
constexpr btScalar kBelow = 2;

bool isOld(const PatchContacts& from, std::uint64_t id) {
  return std::find(from.old_ids.begin(), from.old_ids.end(), id) != from.old_ids.end();
}

/// Contacts far less deep than the deepest only touch because they were enlarged. A cap's depth is about
/// twice its volume over its area; a sphere that is inside as a whole has no area, and stays.
void dropFar(const PatchContacts& from, std::vector<std::size_t>& near) {
  const auto depth = [&](std::size_t i) {
    const btScalar area = toBullet(from.contacts[i].area).length();
    return area > 0 ? 2 * from.contacts[i].volume / area : btScalar(0);
  };
  btScalar deepest = 0;
  for (std::size_t i : near) deepest = btMax(deepest, depth(i));
  near.erase(std::remove_if(near.begin(), near.end(),
                            [&](std::size_t i) {
                              const btScalar d = depth(i);
                              return d > 0 && d < deepest - kBelow * from.spacing;
                            }),
             near.end());
}

struct Furthest {
  std::size_t index = 0;
  btScalar distance = -BT_LARGE_FLOAT;

  void update(std::size_t i, btScalar d) {
    if (d > distance) *this = {i, d};
  }
};

/// Those that span the patch.
void pickOutermost(const PatchContacts& from, const std::vector<std::size_t>& near,
                   std::vector<std::size_t>& picked) {
  std::array<btVector3, kDirections> directions;
  for (int k = 0; k < kDirections; ++k) {
    const btScalar angle = btScalar(k) * SIMD_2_PI / kDirections;
    directions[k] = from.moments.tangent[0] * btCos(angle) + from.moments.tangent[1] * btSin(angle);
  }
  std::array<Furthest, kDirections> furthest;
  for (std::size_t i : near) {
    const btVector3 centroid = toBullet(from.contacts[i].centroid);
    for (int k = 0; k < kDirections; ++k) furthest[k].update(i, directions[k].dot(centroid));
  }
  for (const Furthest& f : furthest) picked.push_back(f.index);
}

/// The eighth of the plane that a place is in, in any order.
std::size_t sectorOf(btScalar u, btScalar v) {
  return (u < 0 ? 1 : 0) + (v < 0 ? 2 : 0) + (btFabs(u) < btFabs(v) ? 4 : 0);
}

/// Where solids are bumpy, a corner or a foot stands out, and small spheres in it.
void pickForward(const PatchContacts& from, const std::vector<std::size_t>& near,
                 std::vector<std::size_t>& picked) {
  std::array<Furthest, 2 * kSectors> furthest;
  for (std::size_t i : near) {
    const btVector3 side = toBullet(from.contacts[i].centroid) - from.moments.centre;
    const std::size_t sector = sectorOf(side.dot(from.moments.tangent[0]), side.dot(from.moments.tangent[1]));
    const SurfaceProbe::Forward forward = from.probe.forward(i, from.moments.normal);
    furthest[2 * sector + (forward.of_a ? 0 : 1)].update(i, forward.distance);
  }
  for (const Furthest& f : furthest) {
    if (f.distance > -BT_LARGE_FLOAT) picked.push_back(f.index);
  }
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

void appendSamples(const PatchContacts& from, Samples& samples) {
  static thread_local std::vector<std::size_t> near, picked;
  const auto append = [&](const std::vector<std::size_t>& indices) {
    samples.indices.insert(samples.indices.end(), indices.begin(), indices.end());
    samples.patches.push_back(
        {from.moments.normal, from.moments.area, from.moments.radius, samples.indices.size()});
  };
  near = from.indices;
  if (from.probe.exactB()) dropFar(from, near);
  if (near.size() <= kDirections + kFacing + kOthers) return append(near);
  picked.clear();
  for (std::size_t i : near) {
    if (isOld(from, from.probe.id(i))) picked.push_back(i);
  }
  pickOutermost(from, near, picked);
  for (std::size_t k = 0; k < kOthers; ++k) picked.push_back(near[k * near.size() / kOthers]);
  pickForward(from, near, picked);
  const auto facing = [&](std::size_t i) { return from.moments.normal.dot(toBullet(from.contacts[i].area)); };
  std::partial_sort(near.begin(), near.begin() + kFacing, near.end(),
                    [&](std::size_t i, std::size_t j) { return facing(i) > facing(j); });
  picked.insert(picked.end(), near.begin(), near.begin() + kFacing);
  std::sort(picked.begin(), picked.end());
  picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
  append(picked);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
