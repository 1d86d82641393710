#include "poses.hpp"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <cmath>

namespace innersphere::python {
namespace {

std::string text(const std::vector<std::size_t>& shape) {
  std::string all;
  for (const std::size_t n : shape) all += std::to_string(n) + (shape.size() == 1 ? "," : ", ");
  if (shape.size() > 1) all.resize(all.size() - 2);
  return "(" + all + ")";
}

[[noreturn]] void valueError(const std::string& message) {
  throw nb::value_error(message.c_str());
}

}  // namespace

std::vector<std::size_t> commonShape(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b,
                                     const std::string& what) {
  const auto& longer = a.size() >= b.size() ? a : b;
  const auto& shorter = a.size() >= b.size() ? b : a;
  std::vector<std::size_t> shape = longer;
  const std::size_t skip = longer.size() - shorter.size();
  for (std::size_t k = 0; k < shorter.size(); ++k) {
    std::size_t& n = shape[skip + k];
    if (n == 1) {
      n = shorter[k];
    } else if (shorter[k] != 1 && shorter[k] != n) {
      valueError(what + " cannot be broadcast together: " + text(a) + " and " + text(b) + " poses");
    }
  }
  return shape;
}

const double* Poses::Operand::at(const std::vector<std::size_t>& index) const {
  std::int64_t offset = 0;
  for (std::size_t k = 0; k < index.size(); ++k) offset += static_cast<std::int64_t>(index[k]) * strides[k];
  return array.data() + offset;
}

void Poses::Operand::broadcast(const std::vector<std::size_t>& to) {
  std::vector<std::int64_t> wide(to.size(), 0);
  const std::size_t skip = to.size() - shape.size();
  for (std::size_t k = 0; k < shape.size(); ++k) wide[skip + k] = shape[k] == 1 ? 0 : strides[k];
  shape = to;
  strides = std::move(wide);
}

/// Whether all elements lie one after the other, in C's order.
bool Poses::Operand::isInRow() const {
  std::int64_t next = 1;
  for (std::size_t k = inner.size(); k-- > 0;) {
    if (inner[k] != next) return false;
    next *= static_cast<std::int64_t>(array.shape(array.ndim() - inner.size() + k));
  }
  for (std::size_t k = shape.size(); k-- > 0;) {
    if (shape[k] != 1 && strides[k] != next) return false;
    next *= static_cast<std::int64_t>(shape[k]);
  }
  return true;
}

Poses::Operand Poses::operand(nb::handle object, const std::vector<std::size_t>& inner_shape,
                              const std::string& name) {
  Operand one;
  if (!nb::try_cast(object, one.array, false)) {
    // Lists, and arrays of other types: numpy makes an array of doubles, or a TypeError.
    const nb::object array = nb::module_::import_("innersphere._arrays").attr("as_float64")(object, name);
    one.array = nb::cast<Array>(array);
  }
  const std::size_t inner = inner_shape.size();
  std::vector<std::size_t> shape;
  for (std::size_t k = 0; k < one.array.ndim(); ++k) shape.push_back(one.array.shape(k));
  if (shape.size() < inner || !std::equal(inner_shape.begin(), inner_shape.end(), shape.end() - inner)) {
    std::string wanted = "(...";
    for (const std::size_t n : inner_shape) wanted += ", " + std::to_string(n);
    valueError(name + " has the shape " + text(shape) + "; it must be " + wanted + ")");
  }
  for (std::size_t k = 0; k < shape.size(); ++k) {
    (k < shape.size() - inner ? one.strides : one.inner).push_back(one.array.stride(k));
  }
  shape.resize(shape.size() - inner);
  one.shape = std::move(shape);
  return one;
}

Poses::Poses(nb::handle poses, const std::string& name) : name_(name) {
  if (poses.is_none()) return;
  if (nb::isinstance<nb::tuple>(poses)) {
    const nb::tuple parts = nb::borrow<nb::tuple>(poses);
    if (parts.size() != 2) {
      valueError(name + " is a tuple of " + std::to_string(parts.size()) +
                 "; a tuple holds positions and quaternions, anything else is an array (..., 4, 4)");
    }
    operands_.push_back(operand(parts[0], {3}, "the position of " + name));
    operands_.push_back(operand(parts[1], {4}, "the quaternion of " + name));
    shape_ = commonShape(operands_[0].shape, operands_[1].shape, "the positions and quaternions of " + name);
  } else {
    operands_.push_back(operand(poses, {4, 4}, name));
    shape_ = operands_[0].shape;
  }
  broadcast(shape_);
}

void Poses::broadcast(const std::vector<std::size_t>& shape) {
  for (Operand& one : operands_) one.broadcast(shape);
  shape_ = shape;
}

innersphere::Poses Poses::inPlace() const {
  innersphere::Poses poses;
  if (operands_.empty()) return poses;
  for (const Operand& one : operands_) {
    if (!one.isInRow()) return poses;
  }
  poses.count = 1;
  for (const std::size_t n : shape_) poses.count *= n;
  if (operands_.size() == 1) {
    poses.matrices = operands_[0].array.data();
  } else {
    poses.positions = operands_[0].array.data();
    poses.quaternions = operands_[1].array.data();
  }
  return poses;
}

Placement Poses::placement(std::size_t number, const std::vector<std::size_t>& at) const {
  Placement place;
  if (operands_.empty()) return place;
  const double* first = operands_[0].at(at);
  const std::vector<std::int64_t>& step = operands_[0].inner;
  if (operands_.size() == 1) {
    const auto element = [&](int i, int j) { return first[i * step[0] + j * step[1]]; };
    constexpr double kRounding = 1e-6;
    for (int j = 0; j < 4; ++j) {
      if (!(std::fabs(element(3, j) - (j == 3 ? 1 : 0)) <= kRounding)) {
        throw Error(ErrorCode::bad_argument, "query " + std::to_string(number) + ": the last row of " +
                                                 name_ + " is not 0 0 0 1; matrices act on columns");
      }
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) place.rotation[3 * i + j] = element(i, j);
      place.translation[i] = element(i, 3);
    }
    return place;
  }
  for (int i = 0; i < 3; ++i) place.translation[i] = first[i * step[0]];
  // Not normalised: a quaternion that is none gives a matrix that is no rotation, which the query refuses.
  const double* q = operands_[1].at(at);
  const std::int64_t next = operands_[1].inner[0];
  const double x = q[0], y = q[next], z = q[2 * next], w = q[3 * next];
  place.rotation = {
      w * w + x * x - y * y - z * z, 2 * (x * y - z * w),           2 * (x * z + y * w),
      2 * (x * y + z * w),           w * w - x * x + y * y - z * z, 2 * (y * z - x * w),
      2 * (x * z - y * w),           2 * (y * z + x * w),           w * w - x * x - y * y + z * z};
  return place;
}

}  // namespace innersphere::python
