#include "machine.hpp"

#include <sys/resource.h>

#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <sstream>
#include <thread>

namespace innersphere::benchmarks {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

// Without the folders: where the files lie is nobody's business.
std::string withoutFolders(const std::string& argument) {
  std::string text;
  for (const char c : argument) {
    text += c;
    if (c == '/') text.erase(text.find_last_of('=') + 1);  // npos + 1 is 0
  }
  return text;
}

std::string commit() {
  std::string text;
  if (FILE* pipe = popen("git -C '" INNERSPHERE_SOURCE_DIR "' describe --always --dirty 2>/dev/null", "r")) {
    std::array<char, 64> line{};
    if (fgets(line.data(), line.size(), pipe)) text = line.data();
    pclose(pipe);
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.empty() ? "unknown" : text;
}

}  // namespace

std::string heading(const std::string& title, int argc, char** argv) {
  const std::time_t now = std::time(nullptr);
  std::array<char, 32> date{};
  std::strftime(date.data(), date.size(), "%Y-%m-%d", std::gmtime(&now));
  std::ostringstream text;
  text << "# " << title << "\n\n* machine: " << processor() << ", " << std::thread::hardware_concurrency()
       << " hardware threads\n* date: " << date.data() << ", commit " << commit()
       << "\n* command: `tests/benchmarks/run.sh";
  for (int i = 0; i < argc; ++i) text << ' ' << withoutFolders(argv[i]);
  text << "`\n\n";
  return text.str();
}

double peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

}  // namespace innersphere::benchmarks
