// What the parts of the Python module share.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "innersphere/collision_model.hpp"
#include "innersphere/error.hpp"
#include "innersphere/query.hpp"

namespace innersphere::python {

namespace nb = nanobind;

/// Is `Packing` in Python: the first `count` spheres of a packing that is ready for queries. Slices share
/// the model, and with it the grids that queries have built.
struct SharedPacking {
  std::shared_ptr<const CollisionModel> model;
  std::uint32_t count = 0;

  const Packing& packing() const { return model->packing(); }
  bool whole() const { return count == packing().spheres.size(); }
};

/// Returns what a word of Python's stands for. Throws Error bad_argument, which lists the words.
template <typename T, std::size_t N>
T parseWord(const char* argument, const std::string& word, const std::pair<const char*, T> (&words)[N]) {
  std::string known;
  for (const auto& [name, value] : words) {
    if (word == name) return value;
    known += (known.empty() ? "'" : ", '") + std::string(name) + "'";
  }
  throw Error(ErrorCode::bad_argument,
              std::string(argument) + " is '" + word + "'; it must be one of " + known);
}

/// Python's words for backends.
inline constexpr std::pair<const char*, Backend> kBackends[] = {
    {"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"cuda", Backend::cuda}};

void bindErrors();
void bindPacking(nb::module_& module);
void bindOverlaps(nb::module_& module);
void bindPyBullet(nb::module_& module);

}  // namespace innersphere::python
