// Rows beside a table, for plots.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace innersphere::benchmarks {

/// A text file that is written only if a path is given.
class PointsFile {
 public:
  explicit PointsFile(const std::string& path)
      : wanted_(!path.empty()), file_(wanted_ ? std::fopen(path.c_str(), "w") : nullptr, std::fclose) {
    if (!good()) std::fprintf(stderr, "cannot write %s\n", path.c_str());
  }
  /// False if the file could not be opened, which stderr has been told.
  bool good() const { return !wanted_ || file_ != nullptr; }
  FILE* get() const { return file_.get(); }  ///< null if none is wanted

 private:
  bool wanted_;
  std::unique_ptr<FILE, int (*)(FILE*)> file_;
};

}  // namespace innersphere::benchmarks
