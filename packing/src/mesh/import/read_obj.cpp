#include <algorithm>
#include <iterator>

#include "mesh/import/polygons.hpp"
#include "mesh/import/readers.hpp"
#include "mesh/import/text_cursor.hpp"

namespace innersphere {
namespace {

// Lines that say nothing of triangles: normals, names, materials, points, curves on surfaces that are not
// read.
constexpr std::string_view kSkipped[] = {
    "vt", "vn",  "vp",    "g",        "o",        "s",          "mg",        "usemtl", "mtllib", "p",
    "l",  "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj", "maplib", "usemap"};

// x y z, then w or a colour.
Vec3d readVertex(TextCursor& cursor) {
  Vec3d p{cursor.numberInLine(), cursor.numberInLine(), cursor.numberInLine()};
  const std::string_view fourth = cursor.wordInLine();
  if (fourth.empty() || !cursor.wordInLine().empty()) return p;
  const double w = cursor.numberFrom(fourth);
  if (w == 0) cursor.fail("a vertex with the weight 0 is nowhere; export the mesh again");
  return {p[0] / w, p[1] / w, p[2] / w};
}

// Corners are "vertex", "vertex/texture" or "vertex/texture/normal", counted from 1, or from -1 backwards.
void readFace(TextCursor& cursor, Polygons& polygons) {
  const std::size_t place = cursor.place();
  for (auto word = cursor.wordInLine(); !word.empty(); word = cursor.wordInLine()) {
    const std::int64_t number = cursor.integerFrom(word.substr(0, word.find('/')));
    if (number == 0) cursor.fail("a corner uses vertex 0; the first of an OBJ file is 1");
    const auto count = static_cast<std::int64_t>(polygons.vertices.size());
    polygons.addCorner(number < 0 ? count + number : number - 1, cursor);
  }
  polygons.endFace(place);
}

}  // namespace

Mesh readObj(std::string_view bytes, const std::string& path) {
  TextCursor cursor(bytes, path, '#', '\\');
  Polygons polygons;
  std::string unknown;
  do {
    const std::string_view keyword = cursor.wordInLine();
    if (keyword == "v") {
      polygons.addVertex(readVertex(cursor), cursor);
    } else if (keyword == "f" || keyword == "fo") {
      readFace(cursor, polygons);
    } else if (keyword == "surf") {
      cursor.fail("curved surfaces (surf) are not read; export triangles");
    } else if (!keyword.empty() && unknown.empty() &&
               std::find(std::begin(kSkipped), std::end(kSkipped), keyword) == std::end(kSkipped)) {
      unknown = path + ", line " + std::to_string(cursor.line()) + ": " + quoted(keyword) +
                " begins no line of an OBJ file; use the matching ending";
    }
  } while (cursor.nextLine());
  Mesh mesh = std::move(polygons).triangulate(path, "line");
  // Writers add keywords of their own; where nothing else is in a file, it is no OBJ file.
  if (mesh.vertices.empty() && !unknown.empty()) throw Error(ErrorCode::bad_format, unknown);
  return mesh;
}

}  // namespace innersphere
