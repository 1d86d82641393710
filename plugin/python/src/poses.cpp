#include "poses.hpp"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "innersphere/query.hpp"

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
                              const std::string& name, Where where) {
  Operand one;
  if (!nb::try_cast(object, one.array, false) || one.array.device_type() != nb::device::cpu::value) {
    const nb::module_ arrays = nb::module_::import_("innersphere._arrays");
    const bool stays = where == Where::anywhere && cudaAvailable() &&
                       nb::try_cast(arrays.attr("on_device")(object), one.array, false);
    // Lists, and arrays of other types: numpy makes an array of doubles, or a TypeError.
    const char* wanted =
        inner_shape.size() == 2 ? "; it must be (..., 4, 4), or a tuple of positions and quaternions" : "";
    if (!stays) one.array = nb::cast<Array>(arrays.attr("as_float64")(object, name, wanted));
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

Poses::Poses(nb::handle poses, const std::string& name, Where where) : name_(name) {
  if (poses.is_none()) return;
  take(poses, where);
  if (onDevice() && inPlace().count == 0) take(poses, Where::host);
}

void Poses::take(nb::handle poses, Where where) {
  operands_.clear();
  if (nb::isinstance<nb::tuple>(poses)) {
    const nb::tuple parts = nb::borrow<nb::tuple>(poses);
    if (parts.size() != 2) {
      valueError(name_ + " is a tuple of " + std::to_string(parts.size()) +
                 "; a tuple holds positions and quaternions, anything else is an array (..., 4, 4)");
    }
    operands_.push_back(operand(parts[0], {3}, "the position of " + name_, where));
    operands_.push_back(operand(parts[1], {4}, "the quaternion of " + name_, where));
    shape_ = commonShape(operands_[0].shape, operands_[1].shape, "the positions and quaternions of " + name_);
  } else {
    operands_.push_back(operand(poses, {4, 4}, name_, where));
    shape_ = operands_[0].shape;
  }
  broadcast(shape_);
}

bool Poses::onDevice() const {
  return std::any_of(operands_.begin(), operands_.end(), [](const Operand& one) { return one.onDevice(); });
}

void Poses::broadcast(const std::vector<std::size_t>& shape) {
  for (Operand& one : operands_) one.broadcast(shape);
  shape_ = shape;
}

innersphere::Poses Poses::inPlace() const {
  innersphere::Poses poses;
  if (operands_.empty()) return poses;
  for (const Operand& one : operands_) {
    if (!one.isInRow() || one.onDevice() != operands_[0].onDevice()) return poses;
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
  if (operands_.empty()) return {};
  double matrix[16], quaternion[4];
  const auto gather = [&](const Operand& from, double* to) {
    const double* first = from.at(at);
    const std::int64_t rows = from.inner.size() == 2 ? 4 : 1;
    const std::int64_t columns = static_cast<std::int64_t>(from.array.shape(from.array.ndim() - 1));
    for (std::int64_t i = 0; i < rows; ++i) {
      for (std::int64_t j = 0; j < columns; ++j)
        *to++ = first[(rows > 1 ? i * from.inner[0] : 0) + j * from.inner.back()];
    }
  };
  innersphere::Poses one;
  one.count = 1;
  gather(operands_[0], matrix);
  if (operands_.size() == 1) {
    one.matrices = matrix;
  } else {
    gather(operands_[1], quaternion);
    one.positions = matrix;
    one.quaternions = quaternion;
  }
  const std::optional<Placement> place = placementAt(one, 0);
  if (!place) {
    if (!std::all_of(matrix + 12, matrix + 16, [](double x) { return std::isfinite(x); })) {
      throw Error(ErrorCode::not_finite, "query " + std::to_string(number) + ": the placement of " + name_ +
                                             " has a number that is not finite");
    }
    throw Error(ErrorCode::bad_argument, "query " + std::to_string(number) + ": the last row of " + name_ +
                                             " is not 0 0 0 1; matrices act on columns");
  }
  return *place;
}

}  // namespace innersphere::python
