#include "mesh/import/ply_header.hpp"

#include "mesh/import/text_cursor.hpp"

namespace innersphere {
namespace {

using Type = PlyProperty::Type;

Type typeFrom(std::string_view word, const TextCursor& cursor) {
  struct Name {
    std::string_view old_name, name;
    Type type;
  };
  static constexpr Name kNames[] = {
      {"char", "int8", Type::int8},        {"uchar", "uint8", Type::uint8},
      {"short", "int16", Type::int16},     {"ushort", "uint16", Type::uint16},
      {"int", "int32", Type::int32},       {"uint", "uint32", Type::uint32},
      {"float", "float32", Type::float32}, {"double", "float64", Type::float64}};
  for (const Name& known : kNames) {
    if (word == known.old_name || word == known.name) return known.type;
  }
  cursor.fail(quoted(word) + " is no type of a PLY file");
}

PlyHeader::Format readFormat(TextCursor& cursor) {
  const std::string_view word = cursor.wordInLine();
  if (word == "ascii") return PlyHeader::Format::text;
  if (word == "binary_little_endian") return PlyHeader::Format::little_endian;
  if (word == "binary_big_endian") return PlyHeader::Format::big_endian;
  cursor.fail(quoted(word) + " is no format of a PLY file");
}

PlyProperty readProperty(TextCursor& cursor) {
  PlyProperty property;
  std::string_view word = cursor.wordInLine();
  if (word == "list") {
    property.count = typeFrom(cursor.wordInLine(), cursor);
    if (property.count >= Type::float32) cursor.fail("the length of a list cannot be a broken number");
    word = cursor.wordInLine();
  }
  property.type = typeFrom(word, cursor);
  property.name = cursor.wordInLine();
  return property;
}

// The fewest bytes that one such element takes.
std::size_t leastBytes(const PlyElement& element, PlyHeader::Format format) {
  std::size_t bytes = 0;
  for (const PlyProperty& p : element.properties) {
    const std::size_t binary = sizeOf(p.count == Type::none ? p.type : p.count);
    bytes += format == PlyHeader::Format::text ? 2 : binary;  // a digit and a blank
  }
  return bytes;
}

void requireRoom(const PlyHeader& header, const TextCursor& cursor) {
  for (const PlyElement& element : header.elements) {
    const std::size_t least = leastBytes(element, header.format);
    const auto count = static_cast<std::size_t>(element.count);
    if (least == 0 || count <= (cursor.left() + 1) / least) continue;
    cursor.fail("the file says that it has " + std::to_string(count) + " times \"" + element.name +
                "\" of at least " + std::to_string(least) + " bytes, but only " +
                std::to_string(cursor.left()) + " bytes follow; it was cut, copy or export it again");
  }
}

}  // namespace

std::size_t sizeOf(Type type) {
  static constexpr std::size_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

PlyHeader readPlyHeader(std::string_view bytes, const std::string& path) {
  TextCursor cursor(bytes, path);
  PlyHeader header;
  bool has_format = false;
  if (cursor.wordInLine() != "ply") cursor.fail("a PLY file begins with the line \"ply\"");
  while (cursor.nextLine()) {
    const std::string_view keyword = cursor.wordInLine();
    if (keyword == "format") {
      header.format = readFormat(cursor);
      has_format = true;
    } else if (keyword == "element") {
      PlyElement element;
      element.name = cursor.wordInLine();
      element.count = cursor.integerFrom(cursor.wordInLine());
      if (element.count < 0) cursor.fail("there cannot be fewer than no elements");
      header.elements.push_back(element);
    } else if (keyword == "property") {
      if (header.elements.empty()) cursor.fail("a property comes before all elements");
      header.elements.back().properties.push_back(readProperty(cursor));
    } else if (keyword == "end_header") {
      if (!has_format) cursor.fail("the header does not say which format follows");
      requireRoom(header, cursor);
      cursor.nextLine();
      header.size = cursor.offset();
      header.lines = cursor.line() - 1;
      return header;
    } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
      cursor.fail(quoted(keyword) + " begins no line of a PLY file's header");
    }
  }
  cursor.fail("the header does not end (end_header); the file was cut, copy or export it again");
}

}  // namespace innersphere
