#include "mesh/import/byte_cursor.hpp"
#include "mesh/import/polygons.hpp"
#include "mesh/import/readers.hpp"
#include "mesh/import/text_cursor.hpp"

namespace innersphere {
namespace {

constexpr std::size_t kHeader = 80, kCount = 4, kFacet = 50;  // bytes

std::uint32_t countOf(std::string_view bytes, const std::string& path) {
  ByteCursor cursor(bytes, path);
  cursor.skip(kHeader);
  return cursor.take<std::uint32_t>();
}

// Headers of binary files may begin with "solid" too. Their size gives them away, and if they were cut or
// have something behind them, bytes of zero that do not come before a text's first facet.
bool isBinary(std::string_view bytes, const std::string& path) {
  if (bytes.size() >= kHeader + kCount && bytes.size() == kHeader + kCount + kFacet * countOf(bytes, path)) {
    return true;
  }
  TextCursor cursor(bytes, path);
  if (!sameWord(cursor.word(), "solid")) return bytes.size() >= kHeader + kCount;
  cursor.nextLine();
  const auto second = cursor.word();
  if (sameWord(second, "facet") || sameWord(second, "endsolid")) return false;
  return bytes.find('\0') != std::string_view::npos;
}

template <class Cursor, class Read>
void readTriangle(Cursor& cursor, Polygons& polygons, const Read& readVertex) {
  const std::size_t place = cursor.place();
  for (int k = 0; k < 3; ++k) {
    polygons.addVertex(readVertex(), cursor);
    polygons.addCorner(static_cast<std::int64_t>(polygons.vertices.size()) - 1, cursor);
  }
  polygons.endFace(place);
}

Mesh readBinary(std::string_view bytes, const std::string& path, std::vector<std::string>& notes) {
  ByteCursor cursor(bytes, path);
  cursor.skip(kHeader);
  const auto count = cursor.take<std::uint32_t>();
  if (cursor.left() < kFacet * count || (count == 0 && cursor.left() > 0)) {
    cursor.fail("the file says that it has " + std::to_string(count) + " triangles of 50 bytes, but " +
                std::to_string(cursor.left()) + " bytes follow; it was cut or is no STL file");
  }
  Polygons polygons;
  for (std::uint32_t i = 0; i < count; ++i) {
    cursor.skip(3 * sizeof(float));  // the normal
    readTriangle(cursor, polygons, [&] {
      const double x = cursor.take<float>(), y = cursor.take<float>(), z = cursor.take<float>();
      return Vec3d{x, y, z};
    });
    cursor.skip(2);  // attributes
  }
  if (cursor.left() > 0) {
    notes.push_back("the file goes on for " + std::to_string(cursor.left()) + " bytes behind the " +
                    std::to_string(count) + " triangles that it says it has: they were left out");
  }
  return std::move(polygons).triangulate(path, "byte");
}

Mesh readText(std::string_view bytes, const std::string& path) {
  TextCursor cursor(bytes, path);
  Polygons polygons;
  cursor.expect("solid");
  cursor.nextLine();
  for (auto word = cursor.word(); !word.empty(); word = cursor.word()) {
    if (sameWord(word, "endsolid") || sameWord(word, "solid")) {
      cursor.nextLine();  // leaves its name behind
      continue;
    }
    if (!sameWord(word, "facet")) cursor.fail("\"facet\" or \"endsolid\" is expected, not " + quoted(word));
    cursor.expect("normal");
    for (int k = 0; k < 3; ++k) cursor.word();  // often not a number
    cursor.expect("outer");
    cursor.expect("loop");
    readTriangle(cursor, polygons, [&] {
      cursor.expect("vertex");
      const double x = cursor.number(), y = cursor.number(), z = cursor.number();
      return Vec3d{x, y, z};
    });
    cursor.expect("endloop");
    cursor.expect("endfacet");
  }
  return std::move(polygons).triangulate(path, "line");
}

}  // namespace

Mesh readStl(std::string_view bytes, const std::string& path, std::vector<std::string>& notes) {
  return isBinary(bytes, path) ? readBinary(bytes, path, notes) : readText(bytes, path);
}

}  // namespace innersphere
