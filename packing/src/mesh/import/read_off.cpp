#include "mesh/import/polygons.hpp"
#include "mesh/import/readers.hpp"
#include "mesh/import/text_cursor.hpp"

namespace innersphere {
namespace {

constexpr std::int64_t kLeastVertex = 6;  // bytes of "0 0 0\n"
constexpr std::int64_t kLeastFace = 2;    // bytes of "0\n"

// The keyword may begin with ST, C and N for what vertices have beside their place.
void readKeyword(TextCursor& cursor) {
  const std::string_view keyword = cursor.word();
  std::string_view rest = keyword;
  for (const std::string_view prefix : {"ST", "C", "N"}) {
    if (rest.substr(0, prefix.size()) == prefix) rest.remove_prefix(prefix.size());
  }
  if (rest != "OFF") {
    cursor.fail("an OFF file begins with OFF, not with " + quoted(keyword) +
                (rest.find("OFF") != std::string_view::npos ? "; export points with three numbers" : ""));
  }
}

std::int64_t readCount(TextCursor& cursor, std::int64_t least_bytes, const char* things) {
  const std::string_view word = cursor.word();
  if (sameWord(word, "BINARY")) cursor.fail("binary OFF files are not read; export it as text");
  const std::int64_t count = cursor.integerFrom(word);
  const auto left = static_cast<std::int64_t>(cursor.left());
  if (count < 0 || count > left / least_bytes + 1) {
    cursor.fail("the file says that it has " + std::to_string(count) + " " + things + ", but only " +
                std::to_string(left) + " bytes follow; it was cut, copy or export it again");
  }
  return count;
}

}  // namespace

Mesh readOff(std::string_view bytes, const std::string& path) {
  TextCursor cursor(bytes, path, '#');
  Polygons polygons;
  readKeyword(cursor);
  const std::int64_t vertices = readCount(cursor, kLeastVertex, "vertices");
  const std::int64_t faces = readCount(cursor, kLeastFace, "faces");
  cursor.integer();  // edges, which nobody needs
  for (std::int64_t i = 0; i < vertices; ++i) {
    cursor.nextLine();
    const double x = cursor.number();
    const double y = cursor.numberInLine(), z = cursor.numberInLine();
    polygons.addVertex({x, y, z}, cursor);
  }
  for (std::int64_t i = 0; i < faces; ++i) {
    cursor.nextLine();  // leaves behind the colour of the line before
    const std::int64_t corners = cursor.integer();
    if (corners < 0) cursor.fail("a face cannot have " + std::to_string(corners) + " corners");
    for (std::int64_t k = 0; k < corners; ++k) {
      polygons.addCorner(cursor.integerFrom(cursor.wordInLine()), cursor);
    }
    polygons.endFace(cursor.place());
  }
  return std::move(polygons).triangulate(path, "line");
}

}  // namespace innersphere
