// Declares the one exception type of InnerSphere. Bad input is an Error with a code that a caller can act on;
// a broken invariant is an assert.
#pragma once

#include <stdexcept>
#include <string>

/// Everything that is public lives here.
namespace innersphere {

/// Says what went wrong, for a caller that wants to react. The message says where and what to do.
enum class ErrorCode {
  file_not_found,       ///< The path does not exist, is a folder or cannot be opened.
  file_exists,          ///< The output exists and overwriting was not asked for.
  write_failed,         ///< The disk is full or the folder is not writable. Nothing was left behind.
  bad_format,           ///< The file is not what its ending says, or is damaged.
  unsupported_version,  ///< The packing file was written by a newer version.
  empty_input,          ///< There are no triangles or no spheres.
  not_finite,           ///< There is NaN or infinity where a number is needed.
  not_a_solid,          ///< The mesh does not bound a volume: it is open, not orientable, ...
  bad_argument,         ///< An option or parameter is outside its documented range.
  no_sphere_fits,       ///< The solid, or the options, leave no room for a single sphere.
  cancelled,            ///< The progress callback asked to stop.
  no_device,            ///< CUDA was asked for by name, but there is no toolkit, driver or device.
  device_error,         ///< A CUDA call failed; the message carries its name and place.
  device_out_of_memory  ///< The device cannot hold what the query needs.
};

/// Returns the name of a code as written in this header, for messages and machine-readable output.
const char* toString(ErrorCode code);

/// This is thrown for bad input. what() is one sentence for people: what is wrong, where, and what to do
/// about it.
class Error : public std::runtime_error {
 public:
  /// Makes an error whose what() returns `message`.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  /// Returns what went wrong, for a caller that wants to react.
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace innersphere
