#include <type_traits>
#include <utility>

#include "mesh/import/byte_cursor.hpp"
#include "mesh/import/ply_header.hpp"
#include "mesh/import/polygons.hpp"
#include "mesh/import/readers.hpp"
#include "mesh/import/text_cursor.hpp"

namespace innersphere {
namespace {

using Type = PlyProperty::Type;

// The numbers of a text and of a binary file, one after the other.
class TextNumbers : public TextCursor {
 public:
  using TextCursor::TextCursor;
  double number(Type) { return TextCursor::number(); }
  std::int64_t integer(Type) { return TextCursor::integer(); }
  void skip(Type) {
    if (word().empty()) fail("a number is missing");
  }
};

class BinaryNumbers : public ByteCursor {
 public:
  using ByteCursor::ByteCursor;
  double number(Type type) {
    if (type == Type::float32) return take<float>();
    if (type == Type::float64) return take<double>();
    return static_cast<double>(integer(type));
  }
  std::int64_t integer(Type type) {
    switch (type) {
      case Type::int8:
        return take<std::int8_t>();
      case Type::uint8:
        return take<std::uint8_t>();
      case Type::int16:
        return take<std::int16_t>();
      case Type::uint16:
        return take<std::uint16_t>();
      case Type::int32:
        return take<std::int32_t>();
      case Type::uint32:
        return take<std::uint32_t>();
      default:
        fail("vertices are numbered by broken numbers");
    }
  }
  using ByteCursor::skip;
  void skip(Type type) { number(type); }
};

template <class Numbers>
class PlyBody {
 public:
  explicit PlyBody(Numbers& numbers) : numbers_(numbers) {}

  void read(const PlyElement& element) {
    if (element.properties.empty()) return;  // takes no bytes, however many there are
    for (std::int64_t i = 0; i < element.count; ++i) {
      if (element.name == "vertex") {
        readVertex(element);
      } else {
        readOther(element);
      }
    }
  }

  Polygons polygons;

 private:
  std::int64_t lengthOf(const PlyProperty& list) {
    const std::int64_t length = numbers_.integer(list.count);
    if (length < 0 || length > static_cast<std::int64_t>(numbers_.left()))
      numbers_.fail("a list of " + std::to_string(length) + " numbers does not fit into the file");
    return length;
  }

  void skip(const PlyProperty& property) {
    if (property.count == Type::none) return numbers_.skip(property.type);
    for (std::int64_t k = lengthOf(property); k > 0; --k) numbers_.skip(property.type);
  }

  void readVertex(const PlyElement& element) {
    Vec3d p{};
    int found = 0;
    for (const PlyProperty& property : element.properties) {
      const bool is_place = property.name == "x" || property.name == "y" || property.name == "z";
      if (!is_place || property.count != Type::none) {
        skip(property);
        continue;
      }
      p[static_cast<std::size_t>(property.name[0] - 'x')] = numbers_.number(property.type);
      ++found;
    }
    if (found != 3) numbers_.fail("vertices do not have exactly one x, y and z");
    polygons.addVertex(p, numbers_);
  }

  void readOther(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      const bool has_corners = property.name == "vertex_indices" || property.name == "vertex_index";
      if (!has_corners || property.count == Type::none) {
        skip(property);
      } else if (element.name == "face") {
        readFace(property);
      } else if (element.name == "tristrips") {
        readStrip(property);
      } else {
        skip(property);
      }
    }
  }

  void readFace(const PlyProperty& list) {
    const std::size_t place = numbers_.place();
    for (std::int64_t k = lengthOf(list); k > 0; --k) {
      polygons.addCorner(numbers_.integer(list.type), numbers_);
    }
    polygons.endFace(place);
  }

  // Each vertex makes a triangle with the two before it, every other one turned over; -1 begins a new strip.
  void readStrip(const PlyProperty& list) {
    const std::size_t place = numbers_.place();
    std::int64_t a = 0, b = 0, in_strip = 0;
    for (std::int64_t k = lengthOf(list); k > 0; --k) {
      const std::int64_t c = numbers_.integer(list.type);
      in_strip = c == -1 ? 0 : in_strip + 1;
      if (in_strip >= 3) {
        const bool turned = in_strip % 2 == 0;
        for (std::int64_t v : {turned ? b : a, turned ? a : b, c}) polygons.addCorner(v, numbers_);
        polygons.endFace(place);
      }
      a = b;
      b = c;
    }
  }

  Numbers& numbers_;
};

template <class Numbers>
Mesh readBody(const PlyHeader& header, Numbers&& numbers, const std::string& path, const char* unit) {
  PlyBody<std::remove_reference_t<Numbers>> body(numbers);
  for (const PlyElement& element : header.elements) body.read(element);
  return std::move(body.polygons).triangulate(path, unit);
}

}  // namespace

Mesh readPly(std::string_view bytes, const std::string& path) {
  const PlyHeader header = readPlyHeader(bytes, path);
  if (header.format == PlyHeader::Format::text) {
    TextNumbers numbers(bytes, path);
    for (std::size_t i = 0; i < header.lines; ++i) numbers.nextLine();
    return readBody(header, numbers, path, "line");
  }
  const bool big = header.format == PlyHeader::Format::big_endian;
  BinaryNumbers numbers(bytes, path, big ? std::endian::big : std::endian::little);
  numbers.skip(header.size);
  return readBody(header, numbers, path, "byte");
}

}  // namespace innersphere
