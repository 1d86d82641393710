// Tells the unit of a 3MF file, which assimp does not.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace innersphere {

/// A unit of length by its name, and how many metres it has.
struct LengthUnit {
  std::string name;
  double metres = 1;
};

/// Returns the unit of the model in a 3MF file with these bytes: millimetres where the file names none, as
/// the format says. Nothing if the model is not found, or the unit not known.
std::optional<LengthUnit> unitOf3mf(std::string_view bytes);

}  // namespace innersphere
