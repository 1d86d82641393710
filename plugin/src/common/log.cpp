#include "common/log.hpp"

#include <cstdio>
#include <mutex>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

struct Log {
  std::mutex mutex;
  LogCallback callback;
};

Log& instance() {
  static Log log;
  return log;
}

}  // namespace

void setLogCallback(LogCallback callback) {
  const std::lock_guard<std::mutex> lock(instance().mutex);
  instance().callback = std::move(callback);
}

void log(const std::string& message) {
  const std::lock_guard<std::mutex> lock(instance().mutex);
  if (instance().callback) {
    instance().callback(message);
  } else {
    std::fprintf(stderr, "InnerSphere: %s\n", message.c_str());
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
