#include "innersphere/packing.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>

#include "common/bounds.hpp"
#include "common/steady_math.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

const VolumeTrueRadii* volumeTrueRadii(const Packing& packing, std::size_t count) {
  const VolumeTrueRadii* best = nullptr;
  for (const VolumeTrueRadii& radii : packing.volume_true) {
    if (radii.count <= count && (!best || radii.count > best->count)) best = &radii;
  }
  return best;
}

double overlapDepth(double volume, const Vec3d& area) {
  const double face = steady::pow(volume, 2.0 / 3);  // of a cube
  return volume / std::sqrt(dot(area, area) + face * face);
}

namespace {

/// What holds between two depths: the logarithms are linear.
OverlapErrors::AtDepth between(const OverlapErrors::AtDepth& low, const OverlapErrors::AtDepth& high,
                               double depth) {
  const double part = steady::log2(depth / low.depth) / steady::log2(high.depth / low.depth);
  const auto at = [part](double a, double b) { return steady::pow(a, 1 - part) * steady::pow(b, part); };
  return {depth,
          {at(low.error.mean, high.error.mean), at(low.error.bound, high.error.bound)},
          at(low.volume, high.volume),
          low.power + part * (high.power - low.power)};
}

ExpectedError errorAt(const std::vector<OverlapErrors::AtDepth>& rows, double depth, double volume) {
  if (rows.empty()) return {1, 1};
  const auto next = std::find_if(rows.begin(), rows.end(),
                                 [depth](const OverlapErrors::AtDepth& at) { return at.depth > depth; });
  const OverlapErrors::AtDepth at = next == rows.begin() ? *next
                                    : next == rows.end() ? rows.back()
                                                         : between(*std::prev(next), *next, depth);
  if (!(volume > 0) || at.power == 0) return at.error;
  const double times = steady::pow(at.volume / volume, at.power);
  return {std::min(times * at.error.mean, 1.0), std::min(times * at.error.bound, 1.0)};
}

}  // namespace

ExpectedError expectedError(const OverlapErrors::Estimate& estimate, double depth, double thickness,
                            double volume, double of_larger) {
  // Where copies nearly upon the solid find less than kDeepOverlap, as thin ones do, it begins there.
  if (!estimate.deep.empty() && of_larger > std::min(kDeepOverlap, estimate.deep.front().depth))
    return errorAt(estimate.deep, of_larger, of_larger);
  if (of_larger > kDeepOverlap) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    return {kNan, kNan};
  }
  ExpectedError error = errorAt(estimate.copies, depth, volume);
  // What is shallower than all that planes cut off is not theirs.
  if (thickness > estimate.thickest && !estimate.planes.empty() && depth >= estimate.planes.front().depth) {
    const ExpectedError planes = errorAt(estimate.planes, depth, volume);
    error = {std::min(error.mean, planes.mean), std::min(error.bound, planes.bound)};
  }
  if (estimate.inside.empty() || !(volume > 0)) return error;
  const ExpectedError inside = errorAt(estimate.inside, volume, volume);
  return {std::max(error.mean, inside.mean), std::max(error.bound, inside.bound)};
}

const Coverage* coverageOf(const Packing& packing, std::size_t count) {
  const Coverage* best = nullptr;
  for (const Coverage& coverage : packing.coverage) {
    if (coverage.count <= count && (!best || coverage.count > best->count)) best = &coverage;
  }
  return best;
}

std::string bareSurface(const Packing& packing, std::size_t count) {
  constexpr double kFar = 0.05;
  const Coverage* coverage = coverageOf(packing, count);
  Bounds box = emptyBounds();
  for (const auto& v : packing.surface.vertices) extend(box, {v[0], v[1], v[2]});
  if (!coverage || packing.surface.vertices.empty() || !(coverage->p95 > kFar * diagonal(box))) return {};
  std::ostringstream sentence;
  sentence.precision(3);
  sentence << "5 % of the surface is more than " << coverage->p95 << " m, "
           << 100 * coverage->p95 / diagonal(box) << " % of the diagonal, from the nearest of "
           << coverage->count << " spheres: volumes and contacts by volume leave it out there";
  return sentence.str();
}

namespace {

[[noreturn]] void notFinite(const std::string& what) {
  throw Error(ErrorCode::not_finite, what + " is not finite");
}

void validateSpheres(const std::vector<Sphere>& spheres, SphereOrder order) {
  if (spheres.empty()) throw Error(ErrorCode::empty_input, "the packing has no spheres");
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Sphere& s = spheres[i];
    const auto where = [i] { return "sphere " + std::to_string(i); };
    if (!std::isfinite(s.x) || !std::isfinite(s.y) || !std::isfinite(s.z) || !std::isfinite(s.radius)) {
      notFinite(where());
    }
    if (!(s.radius > 0)) throw Error(ErrorCode::bad_argument, where() + " has a radius that is not positive");
    if (order == SphereOrder::radius && i > 0 && s.radius > spheres[i - 1].radius) {
      throw Error(ErrorCode::bad_argument,
                  where() + " is larger than the one before it; spheres must be sorted by falling radius");
    }
  }
}

void validateRadii(const std::vector<VolumeTrueRadii>& prefixes, std::size_t spheres) {
  for (const VolumeTrueRadii& prefix : prefixes) {
    const auto where = [&] { return "the volume-true radii of prefix " + std::to_string(prefix.count); };
    if (prefix.count == 0 || prefix.count > spheres || prefix.radii.size() != prefix.count) {
      throw Error(ErrorCode::bad_argument, where() + " have the wrong length");
    }
    for (float r : prefix.radii) {
      if (!std::isfinite(r) || !(r > 0)) {
        throw Error(ErrorCode::bad_argument, where() + " are not all positive and finite");
      }
    }
    if (!std::isfinite(prefix.sampling_error)) notFinite("the sampling error of " + where());
  }
}

void validateErrors(const std::vector<OverlapErrors::AtDepth>& rows) {
  double before = 0;
  for (const OverlapErrors::AtDepth& at : rows) {
    for (const double number : {at.depth, at.error.mean, at.error.bound, at.volume, at.power}) {
      if (!std::isfinite(number)) notFinite("a number of the overlap errors");
    }
    if (!(at.volume > 0))
      throw Error(ErrorCode::bad_argument, "a volume of the overlap errors is not positive");
    if (!(at.depth > before))
      throw Error(ErrorCode::bad_argument, "the depths of the overlap errors do not rise");
    before = at.depth;
  }
}

void validateEstimate(const OverlapErrors::Estimate& estimate) {
  validateErrors(estimate.copies);
  validateErrors(estimate.deep);
  validateErrors(estimate.planes);
  validateErrors(estimate.inside);
  if (!std::isfinite(estimate.thickest)) notFinite("a number of the overlap errors");
}

void validateMeasures(const Packing& packing) {
  if (!packing.mass_weights.empty() && packing.mass_weights.size() != packing.spheres.size()) {
    throw Error(ErrorCode::bad_argument, "there are " + std::to_string(packing.mass_weights.size()) +
                                             " mass weights for " + std::to_string(packing.spheres.size()) +
                                             " spheres");
  }
  for (float w : packing.mass_weights) {
    if (!std::isfinite(w) || !(w > 0)) {
      throw Error(ErrorCode::bad_argument, "the mass weights are not all positive and finite");
    }
  }
  for (const Coverage& c : packing.coverage) {
    for (double x : {c.mean, c.p95, c.max, c.farthest[0], c.farthest[1], c.farthest[2], c.uncovered}) {
      if (!std::isfinite(x)) notFinite("a number of the coverage");
    }
  }
  for (double x : {packing.overlap_errors.shallowest, packing.overlap_errors.sampling_error}) {
    if (!std::isfinite(x)) notFinite("a number of the overlap errors");
  }
  for (const OverlapErrors::Prefix& prefix : packing.overlap_errors.prefixes) {
    validateEstimate(prefix.raw);
    validateEstimate(prefix.volume_true);
  }
}

void validateSurface(const Surface& surface) {
  for (const auto& v : surface.vertices) {
    for (float x : v) {
      if (!std::isfinite(x)) notFinite("a vertex of the surface");
    }
  }
  for (const auto& t : surface.triangles) {
    for (std::uint32_t v : t) {
      if (v >= surface.vertices.size()) {
        throw Error(ErrorCode::bad_argument, "a triangle of the surface names vertex " + std::to_string(v) +
                                                 " of " + std::to_string(surface.vertices.size()));
      }
    }
  }
}

void validateNumbers(const Packing& packing) {
  const MassProperties& mass = packing.solid;
  for (double x : packing.origin) {
    if (!std::isfinite(x)) notFinite("the origin");
  }
  for (double x : mass.centre_of_mass) {
    if (!std::isfinite(x)) notFinite("the centre of mass of the solid");
  }
  for (double x : mass.inertia) {
    if (!std::isfinite(x)) notFinite("the inertia of the solid");
  }
  if (!std::isfinite(mass.volume)) notFinite("the volume of the solid");
  const Quality& q = packing.quality;
  const Certificate& c = packing.certificate;
  for (double x : {q.density, q.gap_mean, q.gap_p95, q.gap_max, c.delta, c.largest_missing_radius}) {
    if (!std::isfinite(x)) notFinite("a number of the quality or the certificate");
  }
}

}  // namespace

void validate(const Packing& packing) {
  validateSpheres(packing.spheres, packing.order);
  validateRadii(packing.volume_true, packing.spheres.size());
  validateSurface(packing.surface);
  validateNumbers(packing);
  validateMeasures(packing);
}

}  // namespace innersphere
