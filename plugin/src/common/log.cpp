#include "common/log.hpp"

#include <cstdio>
#include <mutex>
#include <set>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

struct Log {
  std::mutex mutex;
  LogCallback callback;
  std::set<std::string> told;  ///< by logOnce()
};

Log& instance() {
  static Log log;
  return log;
}

/// Call it with the mutex.
void write(const Log& log, const std::string& message) {
  if (log.callback) {
    log.callback(message);
  } else {
    std::fprintf(stderr, "InnerSphere: %s\n", message.c_str());
  }
}

}  // namespace

void setLogCallback(LogCallback callback) {
  const std::lock_guard<std::mutex> lock(instance().mutex);
  instance().callback = std::move(callback);
}

void log(const std::string& message) {
  const std::lock_guard<std::mutex> lock(instance().mutex);
  write(instance(), message);
}

void logOnce(const std::string& message) {
  const std::lock_guard<std::mutex> lock(instance().mutex);
  if (instance().told.insert(message).second) write(instance(), message);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
