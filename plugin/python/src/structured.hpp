// Structured arrays of numpy, of structs of the library.
#pragma once

#include <initializer_list>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"

namespace innersphere::python {

/// A dtype with the fields of a struct: name, type, offset.
inline nb::object structuredType(
    std::size_t size, std::initializer_list<std::tuple<const char*, const char*, std::size_t>> fields) {
  nb::list names, formats, offsets;
  for (const auto& [name, format, offset] : fields) {
    names.append(name);
    formats.append(format);
    offsets.append(offset);
  }
  nb::dict all;
  all["names"] = names;
  all["formats"] = formats;
  all["offsets"] = offsets;
  all["itemsize"] = size;
  return nb::module_::import_("numpy").attr("dtype")(all);
}

/// Gives a vector to numpy, without a copy, as a structured array of one dimension.
template <typename T>
nb::object structuredArray(std::vector<T>&& items, nb::handle type) {
  if (items.empty()) return nb::module_::import_("numpy").attr("empty")(0, type);
  auto* kept = new std::vector<T>(std::move(items));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  const nb::object bytes = nb::cast(nb::ndarray<nb::numpy, std::uint8_t>(
      reinterpret_cast<std::uint8_t*>(kept->data()), {kept->size() * sizeof(T)}, owner));
  return bytes.attr("view")(type);
}

/// Where a member is in its struct, for fields of a dtype.
template <typename Struct, typename Member>
std::size_t offsetIn(const Member Struct::*member) {
  static const Struct one{};
  return static_cast<std::size_t>(reinterpret_cast<const char*>(&(one.*member)) -
                                  reinterpret_cast<const char*>(&one));
}

}  // namespace innersphere::python
