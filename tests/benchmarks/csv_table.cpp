#include "csv_table.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "innersphere/error.hpp"

namespace innersphere::benchmarks {
namespace {

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

CsvTable::CsvTable(const std::string& path) : path_(path) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorCode::file_not_found, "cannot open " + path);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells = cellsOf(line);
    if (!columns_.empty()) {
      rows_.push_back(std::move(cells));
      continue;
    }
    for (const std::string& name : cells) columns_.emplace(name, columns_.size());
  }
}

double CsvTable::number(std::size_t row, const std::string& column) const {
  const auto found = columns_.find(column);
  if (found == columns_.end()) throw Error(ErrorCode::bad_format, path_ + " has no column " + column);
  try {
    return std::stod(rows_.at(row).at(found->second));
  } catch (const std::logic_error&) {
    throw Error(ErrorCode::bad_format, path_ + " has a row without a number " + column);
  }
}

}  // namespace innersphere::benchmarks
