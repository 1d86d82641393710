// The one exception type of InnerSphere. Bad input is an Error with a code that a caller can act on; a broken
// invariant is an assert.
#pragma once

#include <stdexcept>
#include <string>

/// Everything that is public.
namespace innersphere {

/// What went wrong, for a caller that wants to react. The message says where and what to do.
enum class ErrorCode {
  file_not_found,       ///< the path does not exist or cannot be opened
  file_exists,          ///< the output exists and overwriting was not asked for
  write_failed,         ///< the disk is full or the folder is not writable; nothing was left behind
  bad_format,           ///< the file is not what its ending says, or is damaged
  unsupported_version,  ///< a packing file written by a newer version
  empty_input,          ///< no triangles, no spheres
  not_finite,           ///< NaN or infinity where a number is needed
  not_a_solid,          ///< the mesh does not bound a volume: open, not orientable, ...
  bad_argument,         ///< an option or parameter outside its documented range
  no_sphere_fits,       ///< the solid, or the options, leave no room for a single sphere
  cancelled,            ///< the progress callback asked to stop
  no_device,            ///< CUDA was asked for by name, but there is no toolkit, driver or device
  device_error,         ///< a CUDA call failed; the message carries its name and place
  device_out_of_memory  ///< the device cannot hold what the query needs
};

/// Name of a code as written in this header, for messages and machine-readable output.
const char* toString(ErrorCode code);

/// Thrown for bad input. what() is one sentence for people: what is wrong, where, and what to do about it.
class Error : public std::runtime_error {
 public:
  /// The message is what what() returns.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  /// What went wrong, for a caller that wants to react.
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace innersphere
