#include "innersphere/error.hpp"

namespace innersphere {

const char* toString(ErrorCode code) {
  switch (code) {
    case ErrorCode::file_not_found:
      return "file_not_found";
    case ErrorCode::file_exists:
      return "file_exists";
    case ErrorCode::write_failed:
      return "write_failed";
    case ErrorCode::bad_format:
      return "bad_format";
    case ErrorCode::unsupported_version:
      return "unsupported_version";
    case ErrorCode::empty_input:
      return "empty_input";
    case ErrorCode::not_finite:
      return "not_finite";
    case ErrorCode::not_a_solid:
      return "not_a_solid";
    case ErrorCode::bad_argument:
      return "bad_argument";
    case ErrorCode::no_sphere_fits:
      return "no_sphere_fits";
    case ErrorCode::cancelled:
      return "cancelled";
    case ErrorCode::no_device:
      return "no_device";
    case ErrorCode::device_error:
      return "device_error";
    case ErrorCode::device_out_of_memory:
      return "device_out_of_memory";
  }
  return "unknown";
}

}  // namespace innersphere
