// Reads the first lines of a PLY file, which say what follows.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace innersphere {

struct PlyProperty {
  /// The types of numbers; their bytes are given by sizeOf().
  enum class Type { none, int8, uint8, int16, uint16, int32, uint32, float32, float64 };

  std::string name;
  Type type;
  Type count = Type::none;  ///< The type of a list's length; none if the property is no list.
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Format { text, little_endian, big_endian };

  Format format = Format::text;
  std::vector<PlyElement> elements;
  std::size_t size = 0;   ///< bytes, behind which the data begin
  std::size_t lines = 0;  ///< lines
};

std::size_t sizeOf(PlyProperty::Type type);

/// Throws Error bad_format with the line; also if the file is too short for as many elements as it names.
PlyHeader readPlyHeader(std::string_view bytes, const std::string& path);

}  // namespace innersphere
