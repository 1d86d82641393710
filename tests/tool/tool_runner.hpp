// Runs the command-line tool as a user does.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace innersphere::test {

struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
};

std::string readFile(const std::string& path);
void writeFile(const std::string& path, const std::string& text);

/// A test with an empty folder of its own, in which the tool runs.
class ToolTest : public testing::Test {
 protected:
  ToolTest();
  ~ToolTest() override;

  /// Runs `innersphere ARGUMENTS` in the folder; the shell splits the arguments.
  Outcome run(const std::string& arguments) const;

  /// Runs a line of shell in the folder, with $TOOL for the tool.
  Outcome shell(const std::string& line) const;

  /// The same; the test fails unless the tool succeeds without a word on stderr.
  Outcome succeed(const std::string& arguments) const;

  /// Its standard output as JSON.
  nlohmann::json json(const std::string& arguments) const;

  /// The test fails unless the tool ends with this exit code, names each of the words on stderr and leaves
  /// the folder as it was.
  void refuse(const std::string& arguments, int exit_code, const std::vector<std::string>& words) const;

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::set<std::string> files() const;

 private:
  std::string folder_;
};

/// The rows of a CSV text, split at commas; the header row first.
std::vector<std::vector<std::string>> readCsv(const std::string& text);

}  // namespace innersphere::test
