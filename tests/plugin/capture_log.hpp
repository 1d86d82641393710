// What the plug-in says in its log.
#pragma once

#include <string>
#include <vector>

#include "innersphere/log.hpp"

namespace innersphere::test {

/// Takes the messages for as long as it lives.
class CaptureLog {
 public:
  CaptureLog() {
    setLogCallback([this](const std::string& message) { messages.push_back(message); });
  }
  ~CaptureLog() { setLogCallback(nullptr); }
  CaptureLog(const CaptureLog&) = delete;
  CaptureLog& operator=(const CaptureLog&) = delete;
  std::vector<std::string> messages;
};

}  // namespace innersphere::test
