#include "tool_runner.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace innersphere::test {
namespace fs = std::filesystem;

std::string readFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

void writeFile(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

ToolTest::ToolTest() {
  std::string name = (fs::temp_directory_path() / "innersphere-test-XXXXXX").string();
  folder_ = mkdtemp(name.data()) != nullptr ? name : "";
  EXPECT_FALSE(folder_.empty());
}

ToolTest::~ToolTest() {
  if (!folder_.empty()) fs::remove_all(folder_);
}

Outcome ToolTest::shell(const std::string& line) const {
  const std::string out = folder_ + ".out";
  const std::string err = folder_ + ".err";
  const std::string command = "cd '" + folder_ + "' && TOOL='" INNERSPHERE_TOOL "' && { " + line + "\n} >'" +
                              out + "' 2>'" + err + "' </dev/null";
  const int status = std::system(command.c_str());
  Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, readFile(out), readFile(err)};
  fs::remove(out);
  fs::remove(err);
  return outcome;
}

Outcome ToolTest::run(const std::string& arguments) const {
  return shell("\"$TOOL\" " + arguments);
}

Outcome ToolTest::succeed(const std::string& arguments) const {
  Outcome outcome = run("--quiet " + arguments);
  EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
  EXPECT_EQ(outcome.err, "") << arguments;
  return outcome;
}

nlohmann::json ToolTest::json(const std::string& arguments) const {
  const Outcome outcome = succeed(arguments + " --json");
  nlohmann::json value = nlohmann::json::parse(outcome.out, nullptr, false);
  EXPECT_FALSE(value.is_discarded()) << outcome.out;
  return value;
}

void ToolTest::refuse(const std::string& arguments, int exit_code,
                      const std::vector<std::string>& words) const {
  const std::set<std::string> before = files();
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.exit_code, exit_code) << arguments << "\n" << outcome.err;
  for (const std::string& word : words) {
    EXPECT_NE(outcome.err.find(word), std::string::npos) << "no \"" << word << "\" in: " << outcome.err;
  }
  EXPECT_EQ(files(), before) << arguments;
}

std::set<std::string> ToolTest::files() const {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename().string());
  return names;
}

std::vector<std::vector<std::string>> readCsv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::stringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string>& row = rows.emplace_back();
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  return rows;
}

}  // namespace innersphere::test
