// Poses as Python has them: arrays of matrices, or of positions and quaternions, of any strides.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "innersphere/placement.hpp"
#include "innersphere/poses.hpp"

namespace innersphere::python {

/// Says where poses may be read from.
enum class Where { host, anywhere };

/// Holds the poses of one body, without a copy where the array is of double precision.
class Poses {
 public:
  /// Takes None (the identity), an array (..., 4, 4), or a tuple of positions (..., 3) and quaternions
  /// (..., 4), x y z w. `name` is that of the argument. What is on a device stays there if it may, and if it
  /// lies in a row in double precision; else it is copied. Throws Python's TypeError and ValueError. Needs
  /// the GIL, in the destructor, too.
  Poses(nb::handle poses, const std::string& name, Where where = Where::host);

  /// Returns the shape without the dimensions of a single pose.
  const std::vector<std::size_t>& shape() const { return shape_; }

  /// Makes all() give a pose for each element of `shape`, to which its own shape can be broadcast.
  void broadcast(const std::vector<std::size_t>& shape);

  /// Returns whether there is one pose only, and not a shape of them.
  bool isSingle() const { return shape_.empty(); }

  /// Returns the numbers as they lie in memory, one pose after the other, if they do; else null arrays.
  innersphere::Poses inPlace() const;

  /// Returns whether they are in the memory of a device, where forEach() cannot read them.
  bool onDevice() const;

  /// Calls `use(i, placement)` for each element of the shape, in C's order. Does not need the GIL. Throws
  /// Error bad_argument, which names the element, for a matrix whose last row is not 0 0 0 1.
  template <typename Use>
  void forEach(std::size_t count, const Use& use) const {
    std::vector<std::size_t> at(shape_.size(), 0);
    for (std::size_t i = 0; i < count; ++i) {
      use(i, placement(i, at));
      for (std::size_t k = at.size(); k-- > 0;) {
        if (++at[k] < shape_[k]) break;
        at[k] = 0;
      }
    }
  }

 private:
  using Array = nb::ndarray<const double>;

  struct Operand {
    Array array;
    std::vector<std::size_t> shape;     ///< without the last `inner` dimensions
    std::vector<std::int64_t> strides;  ///< of these, in elements
    std::vector<std::int64_t> inner;    ///< the strides of a single pose
    const double* at(const std::vector<std::size_t>& index) const;
    void broadcast(const std::vector<std::size_t>& to);
    bool isInRow() const;
    bool onDevice() const { return array.device_type() == nb::device::cuda::value; }
  };

  void take(nb::handle poses, Where where);
  static Operand operand(nb::handle array, const std::vector<std::size_t>& inner_shape,
                         const std::string& name, Where where);
  Placement placement(std::size_t number, const std::vector<std::size_t>& at) const;

  std::string name_;
  std::vector<Operand> operands_;  ///< none, a matrix, or a position and a quaternion
  std::vector<std::size_t> shape_;
};

/// Returns the shape that both can be broadcast to, as numpy does it. Throws Python's ValueError.
std::vector<std::size_t> commonShape(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b,
                                     const std::string& what);

}  // namespace innersphere::python
