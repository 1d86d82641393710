#include "batch/prepare.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "core/pair_setup.hpp"
#include "grid/model_impl.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

using core::Fault;
using core::Mat3;

namespace {

[[noreturn]] void fail(ErrorCode code, std::size_t index, const std::string& what) {
  throw Error(code, "query " + std::to_string(index) + ": " + what);
}

bool finite(const Placement& placement) {
  const auto all = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
  };
  return all(placement.rotation) && all(placement.translation) && std::isfinite(placement.scale);
}

/// Scale times rotation.
Mat3<double> checkedMatrix(const Placement& placement, std::size_t index, const std::string& name) {
  if (!finite(placement)) failFor(Fault::not_finite, index, name);
  if (!(placement.scale > 0)) {
    fail(ErrorCode::bad_argument, index,
         "the scale of " + name + " is " + std::to_string(placement.scale) + "; it must be positive");
  }
  Mat3<double> matrix;
  std::copy(placement.rotation.begin(), placement.rotation.end(), matrix.m);
  const Fault fault = core::makeRotation(matrix);
  if (fault != Fault::none) failFor(fault, index, name);
  return core::scaled(matrix, placement.scale);
}

}  // namespace

void failFor(Fault fault, std::size_t index, const std::string& name) {
  switch (fault) {
    case Fault::not_finite:
      fail(ErrorCode::not_finite, index, "the placement of " + name + " has a number that is not finite");
    case Fault::not_a_rotation:
      fail(ErrorCode::bad_argument, index,
           "the rotation of " + name + " is off orthonormal by more than " +
               std::to_string(core::kRotationTolerance) +
               ": a quaternion has to have the length 1, and a matrix may only turn (in C++ Placement::scale "
               "scales, in Python solids are packed at their size)");
    case Fault::reflection:
      fail(ErrorCode::bad_argument, index, "the rotation of " + name + " is a reflection");
    case Fault::last_row:
      fail(ErrorCode::bad_argument, index,
           "the last row of the matrix of " + name + " is not 0 0 0 1; matrices act on columns");
    case Fault::scales_differ:
      fail(ErrorCode::bad_argument, index, "the bodies differ too much in scale");
    case Fault::lengths:
      fail(ErrorCode::bad_argument, index,
           "lengths are too small or too large to be summed; scale the scene towards metres");
    case Fault::none:
      break;
  }
  assert(!"a fault is one");
  std::abort();
}

const ModelGrid& KnownGrids::of(const CollisionModel& model, std::uint32_t prefix, Estimator estimator,
                                int side) {
  Known& known = known_[side];
  if (known.model != &model || known.prefix != prefix)
    known = {&model, prefix, &model.impl().grid(prefix, estimator)};
  return *known.grid;
}

PreparedQuery prepare(const PairQuery& query, std::size_t index, Estimator estimator, KnownGrids& grids) {
  if (!query.a || !query.b) fail(ErrorCode::bad_argument, index, "a model is a null pointer");
  const Mat3<double> matrix_a = checkedMatrix(query.placement_a, index, "A");
  const Mat3<double> matrix_b = checkedMatrix(query.placement_b, index, "B");
  if (!std::isfinite(query.margin)) fail(ErrorCode::not_finite, index, "the margin is not finite");
  const double local_margin = query.margin / query.placement_a.scale;
  if (!(query.margin >= 0) || !(local_margin <= 1e15)) {
    fail(
        ErrorCode::bad_argument, index,
        "the margin is " + std::to_string(query.margin) + "; it must be from 0 to 1e15 times the scale of A");
  }

  PreparedQuery prepared;
  prepared.grid_a = &grids.of(*query.a, query.prefix_a, estimator, 0);
  prepared.grid_b = &grids.of(*query.b, query.prefix_b, estimator, 1);
  core::Setup& setup = prepared.setup;
  setup.a = prepared.grid_a->plan().view;
  setup.b = prepared.grid_b->plan().view;
  const core::Side a{setup.a, matrix_a, query.placement_a.scale, query.margin};
  const core::Side b{setup.b, matrix_b, query.placement_b.scale, 0};
  const Fault fault =
      core::makePairSetup(a, b, query.placement_b.translation - query.placement_a.translation, setup);
  if (fault != Fault::none) failFor(fault, index, "B");
  return prepared;
}

void bringToCpu(PreparedQuery& query) {
  if (query.clusters() == 0) return;
  query.setup.a = query.grid_a->onCpu().view();
  query.setup.b = query.grid_b->onCpu().view();
}

}  // namespace innersphere
