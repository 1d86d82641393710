#include "narrow_phase/contact_samples.hpp"

#include <algorithm>
#include <functional>
#include <iterator>

#include "common/contact_tolerances.hpp"
#include "common/parallel.hpp"
#include "narrow_phase/contact_normal.hpp"
#include "narrow_phase/deepest_points.hpp"
#include "narrow_phase/patch_contact_points.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Samples of a patch from which on several threads probe them.
constexpr std::size_t kManySamples = 8;
/// What there is room for from the start: few patches have more samples, and need memory again.
constexpr std::size_t kUsualPatchSamples = 128;

/// One patch of the samples.
struct PatchSamples {
  PatchSamples(Samples& all, std::size_t p)
      : samples(all),
        patch(all.patches[p]),
        begin(p == 0 ? 0 : all.patches[p - 1].end),
        again(patch.end <= all.lines.size()) {}
  std::size_t count() const { return patch.end - begin; }

  Samples& samples;
  const Samples::OfPatch& patch;
  const std::size_t begin;
  const bool again;  ///< they have been probed before
};

ProbedSample sampleAt(const PatchSamples& of, std::size_t i, const ContactSpheres& spheres) {
  ProbedSample sample;
  sample.index = of.samples.indices[of.begin + i];
  sample.id = spheres.id(sample.index);
  return sample;
}

void probeAll(const PackingProbe& probe, const PatchSamples& of, btScalar separation,
              std::vector<SampleScratch::Tried>& tried) {
  tried.resize(of.count());
  const auto probeOne = [&](std::size_t i) {
    ProbedSample sample = sampleAt(of, i, probe);
    const bool found =
        of.again ? probe.probeAgain(of.patch.normal, separation, of.samples.lines[of.begin + i], sample)
                 : probe.probe(of.patch.normal, separation, sample);
    tried[i] = {sample, found};
  };
  // Bodies that are linked have many; other pairs are done long before them.
  if (tried.size() >= kManySamples) {
    inParallel(tried.size(), probeOne);
  } else {
    for (std::size_t i = 0; i < tried.size(); ++i) probeOne(i);
  }
  // A steep ridge in a valley: no line along the patch's normal leaves it by its faces.
  if (std::any_of(tried.begin(), tried.end(), [](const auto& t) { return t.found; })) return;
  for (auto& [sample, found] : tried) found = probe.probeNearest(of.patch.normal, sample);
}

/// By one thread: shapes that are no packings remember what they were asked last.
void probeAll(const ShapeProbe& probe, const PatchSamples& of, std::vector<SampleScratch::Tried>& tried) {
  tried.resize(of.count());
  for (std::size_t i = 0; i < tried.size(); ++i) {
    ProbedSample sample = sampleAt(of, i, probe);
    const bool found =
        of.again ? probe.probeAgain(of.samples.lines[of.begin + i], sample) : probe.probe(sample);
    tried[i] = {sample, found};
  }
}

Samples::Line lineOf(const ProbedSample& sample) {
  return {sample.direction, sample.points.triangle_a, sample.points.triangle_b};
}

/// Sorts what was tried into `probed`, and keeps the lines of those that are near, until the samples are
/// selected again. On flat surfaces those that are far are of use all the same: they tell where faces end.
void keepProbed(const PatchSamples& of, btScalar separation, SampleScratch& scratch) {
  scratch.probed.clear();
  scratch.places.clear();
  if (!of.again) of.samples.lines.resize(of.patch.end);
  for (std::size_t i = 0; i < scratch.tried.size(); ++i) {
    const auto& [sample, found] = scratch.tried[i];
    if (!found) continue;
    scratch.probed.push_back(sample);
    scratch.places.push_back(of.begin + i);
    if (of.again || !sample.isFar(separation)) of.samples.lines[of.begin + i] = lineOf(sample);
  }
}

/// The same for those whose line leaves A by a side: an edge of A is near.
void keepSideways(const PatchSamples& of, SampleScratch& scratch) {
  scratch.sideways.clear();
  for (std::size_t i = 0; i < scratch.tried.size(); ++i) {
    const auto& [sample, found] = scratch.tried[i];
    if (found || sample.points.triangle_a == OpposedPoints::kNone) continue;
    scratch.sideways.push_back(sample);
    of.samples.lines[of.begin + i] = lineOf(sample);
  }
}

/// The same for a sample that gave points: a corner may be near where the line is not.
void keepBearing(const SampleScratch& scratch, std::size_t i, Samples& samples) {
  if (i < scratch.places.size()) samples.lines[scratch.places[i]] = lineOf(scratch.probed[i]);
}

/// From there the ascents start again.
void keepAscents(const SampleScratch& scratch, Samples& samples) {
  for (std::size_t i = 0; i < scratch.places.size(); ++i) {
    if (scratch.probed[i].starts_ascent) samples.lines[scratch.places[i]] = lineOf(scratch.probed[i]);
  }
}

/// Sorts tops so that those whose lines start from samples of the patch come first. Returns their number.
std::size_t sortTops(const PatchSamples& of, const std::vector<Top>& tops, SampleScratch& scratch) {
  const auto first = of.samples.indices.begin() + std::ptrdiff_t(of.begin);
  const auto end = first + std::ptrdiff_t(of.count());
  const auto isOfPatch = [&](const Top& top) { return std::find(first, end, top.sample.index) != end; };
  scratch.tops.clear();
  std::copy_if(tops.begin(), tops.end(), std::back_inserter(scratch.tops), isOfPatch);
  const std::size_t count = scratch.tops.size();
  std::copy_if(tops.begin(), tops.end(), std::back_inserter(scratch.tops), std::not_fn(isOfPatch));
  return count;
}

}  // namespace

SampleScratch::SampleScratch() {
  tried.reserve(kUsualPatchSamples);
  probed.reserve(kUsualPatchSamples);
  places.reserve(kUsualPatchSamples);
  sideways.reserve(kUsualPatchSamples);
  line_starts.reserve(kUsualPatchSamples);
}

void findContactPoints(const PackingProbe& probe, std::size_t p, const ContactReach& reach,
                       const std::vector<Top>& tops, Samples& samples, SampleScratch& scratch,
                       std::vector<WeightedPoint>& found) {
  const PatchSamples of(samples, p);
  probeAll(probe, of, reach.separation, scratch.tried);
  keepProbed(of, reach.separation, scratch);
  const std::size_t tops_of_patch = sortTops(of, tops, scratch);
  const LineStarts lines(probe, samples.indices, scratch.line_starts);
  appendDeepestPoints(lines, reach.separation, scratch.tops, tops_of_patch, scratch.probed);
  keepAscents(scratch, samples);
  const ContactNormal normals(scratch.probed, &probe, &probe);
  PatchContactPoints points(probe, probe, of.patch, reach, scratch, found);
  for (std::size_t i = 0; i < scratch.probed.size(); ++i) {
    const ProbedSample& sample = scratch.probed[i];
    const std::size_t before = found.size();
    if (!sample.isFarFromBend(reach.separation)) points.addSample(sample, normals.at(sample));
    if (found.size() > before) keepBearing(scratch, i, samples);
  }
  points.shareOutArea();
}

void findContactPoints(const ShapeProbe& probe, std::size_t p, const ContactReach& reach,
                       const std::vector<Top>& tops, Samples& samples, SampleScratch& scratch,
                       std::vector<WeightedPoint>& found) {
  const PatchSamples of(samples, p);
  probeAll(probe, of, scratch.tried);
  keepProbed(of, reach.separation, scratch);
  keepSideways(of, scratch);
  const std::size_t count = scratch.probed.size();
  const std::size_t tops_of_patch = sortTops(of, tops, scratch);
  const LineStarts lines(probe, samples.indices, scratch.line_starts);
  appendDeepestPoints(lines, reach.separation, scratch.tops, tops_of_patch, scratch.probed);
  ascendBeside(lines, count, scratch.probed);
  keepAscents(scratch, samples);
  const ContactNormal normals(scratch.probed, probe.extents());
  PatchContactPoints points(probe, probe, of.patch, reach, scratch, found);
  for (std::size_t i = 0; i < scratch.probed.size(); ++i) {
    const std::size_t before = found.size();
    points.addSample(scratch.probed[i], normals.at(scratch.probed[i]));
    if (found.size() > before) keepBearing(scratch, i, samples);
  }
  for (const ProbedSample& sample : scratch.sideways) {
    points.addBeside(sample);
    points.addTips(probe, sample);
  }
  points.shareOutArea();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
