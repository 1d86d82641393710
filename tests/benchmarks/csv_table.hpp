// Tables of numbers in text files.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace innersphere::benchmarks {

/// A CSV file with a header row; lines that start with # are skipped.
class CsvTable {
 public:
  /// Throws Error file_not_found.
  explicit CsvTable(const std::string& path);

  std::size_t rows() const { return rows_.size(); }

  /// Throws Error bad_format if there is no such column, or no number in it.
  double number(std::size_t row, const std::string& column) const;

 private:
  std::string path_;
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace innersphere::benchmarks
