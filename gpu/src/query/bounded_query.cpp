#include "innersphere/bounded_query.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "grid/model_impl.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

namespace {

constexpr std::uint64_t kShortest = 64;  ///< spheres of the first step
constexpr std::size_t kRecent = 8;       ///< queries whose slowest counts
constexpr double kGuess = 2;             ///< growth with twice the spheres
constexpr double kReserve = 1.15;        ///< for what one query differs from the next

std::uint32_t limitOf(const CollisionModel* model, std::uint32_t prefix) {
  if (!model) throw Error(ErrorCode::bad_argument, "a model is a null pointer");
  const auto all = static_cast<std::uint32_t>(model->packing().spheres.size());
  return prefix == 0 ? all : std::min(prefix, all);
}

std::uint32_t lengthAt(std::size_t step, std::uint32_t limit) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(kShortest << step, limit));
}

/// The query with the prefixes of a step.
PairQuery at(std::size_t step, PairQuery query) {
  query.prefix_a = lengthAt(step, limitOf(query.a, query.prefix_a));
  query.prefix_b = lengthAt(step, limitOf(query.b, query.prefix_b));
  return query;
}

/// How many steps it takes to use all spheres.
std::size_t stepsOf(const PairQuery& query) {
  const std::uint32_t longest = std::max(limitOf(query.a, query.prefix_a), limitOf(query.b, query.prefix_b));
  std::size_t steps = 1;
  while (kShortest << (steps - 1) < longest) ++steps;
  return steps;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr ExpectedError kUnknown{kNan, kNan};

/// The errors that a packing, scaled, gives for an overlap with a body of another volume; NaN if it gives
/// none.
ExpectedError errorOf(const Packing& packing, std::uint32_t prefix, double scale, Estimator estimator,
                      const Overlap& found, double other) {
  const OverlapErrors& errors = packing.overlap_errors;
  const OverlapErrors::Prefix* best = nullptr;
  for (const OverlapErrors::Prefix& candidate : errors.prefixes) {
    if (candidate.count <= prefix) best = &candidate;
  }
  const double size = scale * std::cbrt(packing.solid.volume);
  const double fraction = found.volume / (size * size * size);
  if (!best || !(fraction > 0) || fraction < errors.shallowest) return kUnknown;
  // Infinite if all spheres that meet are inside one another: such lenses have no rim.
  const double thickness = found.volume / found.stiffness;
  return expectedError(estimator == Estimator::raw ? best->raw : best->volume_true,
                       overlapDepth(found.volume, found.area) / size, thickness / size, fraction,
                       estimator == Estimator::raw ? 0 : std::min(fraction, found.volume / other));
}

/// The error of a pair. What each packing measured is from two bodies like it, so half of the variance is its
/// own. Logarithms of found over true add up; they have no end, as errors have at 1. NaN if one is.
double together(double a, double b) {
  const double log_a = std::log1p(-a), log_b = std::log1p(-b);
  return -std::expm1(-std::sqrt((log_a * log_a + log_b * log_b) / 2));
}

}  // namespace

ExpectedError expectedError(const PairQuery& query, Estimator estimator, const Overlap& found) {
  const std::uint32_t prefix_a = limitOf(query.a, query.prefix_a),
                      prefix_b = limitOf(query.b, query.prefix_b);
  if (estimator == Estimator::surface) {
    const bool exact = query.a->impl().surfaceHasVolumeOfSolid() && query.b->impl().surfaceHasVolumeOfSolid();
    return exact ? ExpectedError{0, 0} : kUnknown;
  }
  if (found.area == Vec3d{} && found.energy == 0) return kUnknown;
  const Packing &in_a = query.a->packing(), &in_b = query.b->packing();
  const double scale_a = query.placement_a.scale, scale_b = query.placement_b.scale;
  const double volume_a = in_a.solid.volume * std::pow(scale_a, 3),
               volume_b = in_b.solid.volume * std::pow(scale_b, 3);
  const ExpectedError a = errorOf(in_a, prefix_a, scale_a, estimator, found, volume_b),
                      b = errorOf(in_b, prefix_b, scale_b, estimator, found, volume_a);
  return {together(a.mean, b.mean), together(a.bound, b.bound)};
}

void BoundedQuery::warmUp(const PairQuery& query, const QueryOptions& options) {
  const std::size_t steps = stepsOf(query);
  growth_.assign(steps, 0);
  recent_.clear();
  for (std::size_t step = 0; step < steps; ++step) timedRun(query, options, step);
}

BoundedOverlap BoundedQuery::overlap(const PairQuery& query, const QueryBudget& budget,
                                     const QueryOptions& options) {
  if (!(budget.seconds >= 0))
    throw Error(ErrorCode::bad_argument, "the seconds of a budget must be 0 (any) or more");
  const std::size_t step = longestStep(query, budget);
  const PairQuery bounded = at(step, query);
  BoundedOverlap result;
  result.overlap = timedRun(query, options, step);
  result.prefix_a = bounded.prefix_a;
  result.prefix_b = bounded.prefix_b;
  const ExpectedError error = expectedError(bounded, options.estimator, result.overlap);
  result.error = error.mean;
  result.error_bound = error.bound;
  return result;
}

std::size_t BoundedQuery::longestStep(const PairQuery& query, const QueryBudget& budget) const {
  if (budget.seconds > 0 && recent_.empty()) return 0;  // learn first
  std::size_t step = 0;
  for (std::size_t next = 0; next < stepsOf(query); ++next) {
    const PairQuery bounded = at(next, query);
    const std::uint64_t spheres = std::uint64_t{bounded.prefix_a} + bounded.prefix_b;
    if (budget.spheres > 0 && spheres > budget.spheres) break;
    if (budget.seconds > 0 && kReserve * predicted(next) > budget.seconds) break;
    step = next;
  }
  return step;
}

double BoundedQuery::predicted(std::size_t step) const {
  double slowest = 0;
  for (const Run& run : recent_) {
    double seconds = run.seconds;
    const auto growth = [&](std::size_t k) {
      return k < growth_.size() && growth_[k] > 0 ? growth_[k] : kGuess;
    };
    for (std::size_t k = run.step; k < step; ++k) seconds *= growth(k + 1);
    for (std::size_t k = run.step; k > step; --k) seconds /= growth(k);
    slowest = std::max(slowest, seconds);
  }
  return slowest;
}

Overlap BoundedQuery::timedRun(const PairQuery& query, const QueryOptions& options, std::size_t step) {
  const PairQuery bounded = at(step, query);
  if (growth_.size() <= step) growth_.resize(step + 1, 0);
  const bool is_new = !(growth_[step] > 0);
  if (is_new) context_.overlap(bounded, options);  // builds grids, which is not for the clock
  const auto start = std::chrono::steady_clock::now();
  const Overlap overlap = context_.overlap(bounded, options);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  const Run now{step, time.count()};
  if (!recent_.empty()) learnGrowth(recent_.back(), now);
  if (!(growth_[step] > 0)) growth_[step] = kGuess;
  if (recent_.size() == kRecent) recent_.erase(recent_.begin());
  recent_.push_back(now);
  return overlap;
}

/// Two queries after each other with different steps tell how the steps compare, give or take what moved.
void BoundedQuery::learnGrowth(const Run& before, const Run& now) {
  if (now.step == before.step) return;
  constexpr double kLearn = 0.3, kMost = 3;
  const bool up = now.step > before.step;
  const Run &low = up ? before : now, &high = up ? now : before;
  const double seen =
      std::pow(high.seconds / std::max(low.seconds, 1e-9), 1.0 / static_cast<double>(high.step - low.step));
  for (std::size_t k = low.step + 1; k <= high.step; ++k) {
    const double times = std::clamp(seen, 1.0, kMost);
    growth_[k] = growth_[k] > 0 ? growth_[k] + kLearn * (times - growth_[k]) : times;
  }
}

}  // namespace innersphere
