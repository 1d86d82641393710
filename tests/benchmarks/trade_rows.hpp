// What the trade of speed for accuracy is measured as: one row for each way to collide and each truth.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

#include "innersphere/contact_options.hpp"
#include "scenes/body_shape.hpp"

namespace innersphere::benchmarks {

/// One way to collide: everything that a user chooses.
struct Way {
  demo::BodyShape shape = demo::BodyShape::packing;
  std::size_t spheres = 1000;  ///< of packings and of compounds of spheres
  double concavity = 0;        ///< of convex parts, relative to the solid's size
  Response response = Response::compliant;
  Estimator estimator = Estimator::volume_true;
  Backend backend = Backend::cpu;
  double rate = 240;  ///< time steps per second; 0 where nothing moves
};

std::string nameOf(demo::BodyShape shape);
std::string nameOf(Response response);

/// "packing, 1024 spheres, rigid, 60 Hz": what sets it apart.
std::string describe(const Way& way);

struct Measured {
  std::string scene;
  std::string measure;
  std::size_t pieces = 0;  ///< spheres, triangles or hulls of one body
  double value = 0;
  double error = 0;
  std::string unit;  ///< of the error: % or deg
  double time = 0;   ///< processor time of a step or of a query [us]
};

/// A CSV table that grows row by row.
class TradeTable {
 public:
  /// Writes to a file that stays the caller's, beginning with the heading as lines of comment.
  TradeTable(FILE* file, const std::string& heading);
  void add(const Way& way, const Measured& measured);

 private:
  FILE* file_;
};

}  // namespace innersphere::benchmarks
