// What the tool's exit status says.
#pragma once

#include "innersphere/error.hpp"

namespace innersphere::tool {

enum ExitCode : int {
  kOk = 0,
  kCheckFailed = 1,    ///< the command worked, and its answer is no: a packing is not valid
  kBadUsage = 2,       ///< unknown option or command, a value out of range
  kBadInput = 3,       ///< a file or name that cannot be used
  kCancelled = 4,      ///< Ctrl-C
  kBadOutput = 5,      ///< the output exists (see --force) or cannot be written
  kDeviceFailed = 6,   ///< CUDA was asked for and is not there, or failed
  kInternalError = 70  ///< a defect of this program
};

/// For help and the manual page.
inline constexpr const char* kExitCodeHelp =
    "Exit status: 0 done; 1 checked and found wrong; 2 bad usage; 3 bad input; 4 cancelled; "
    "5 output exists or cannot be written; 6 CUDA device missing or failed; 70 defect of this program.";

inline ExitCode exitCodeOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::file_exists:
    case ErrorCode::write_failed:
      return kBadOutput;
    case ErrorCode::cancelled:
      return kCancelled;
    case ErrorCode::bad_argument:
      return kBadUsage;
    case ErrorCode::no_device:
    case ErrorCode::device_error:
    case ErrorCode::device_out_of_memory:
      return kDeviceFailed;
    default:
      return kBadInput;
  }
}

}  // namespace innersphere::tool
