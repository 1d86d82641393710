#include "trade_rows.hpp"

#include <sstream>

namespace innersphere::benchmarks {

std::string nameOf(demo::BodyShape shape) {
  switch (shape) {
    case demo::BodyShape::packing:
      return "packing";
    case demo::BodyShape::gimpact:
      return "gimpact";
    case demo::BodyShape::spheres:
      return "spheres";
    case demo::BodyShape::convex:
      return "convex";
  }
  return {};
}

std::string nameOf(Response response) {
  return response == Response::rigid ? "rigid" : response == Response::penalty ? "penalty" : "compliant";
}

std::string describe(const Way& way) {
  std::ostringstream text;
  text << nameOf(way.shape);
  if (way.shape == demo::BodyShape::convex) text << ", concavity " << way.concavity;
  if (way.shape == demo::BodyShape::packing || way.shape == demo::BodyShape::spheres) {
    text << ", " << way.spheres << " spheres";
  }
  if (way.shape == demo::BodyShape::packing) {
    text << ", " << nameOf(way.response) << (way.estimator == Estimator::raw ? ", raw" : "")
         << (way.backend == Backend::cuda ? ", CUDA" : "");
  }
  if (way.rate > 0) text << ", " << way.rate << " Hz";
  return text.str();
}

TradeTable::TradeTable(FILE* file, const std::string& heading) : file_(file) {
  std::istringstream lines(heading);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] != '#') std::fprintf(file_, "# %s\n", line.c_str());
  }
  std::fprintf(file_,
               "scene,measure,way,pieces,response,estimator,backend,steps_per_s,value,error,error_unit,"
               "processor_us\n");
}

void TradeTable::add(const Way& way, const Measured& measured) {
  const bool packing = way.shape == demo::BodyShape::packing;
  std::fprintf(file_, "%s,%s,%s,%zu,%s,%s,%s,%g,%.6g,%.4g,%s,%.4g\n", measured.scene.c_str(),
               measured.measure.c_str(), nameOf(way.shape).c_str(), measured.pieces,
               packing && way.rate > 0 ? nameOf(way.response).c_str() : "-",
               !packing                          ? "-"
               : way.estimator == Estimator::raw ? "raw"
                                                 : "volume-true",
               way.backend == Backend::cuda ? "cuda" : "cpu", way.rate, measured.value, measured.error,
               measured.unit.c_str(), measured.time);
  std::fflush(file_);
}

}  // namespace innersphere::benchmarks
