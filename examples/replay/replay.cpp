#include "replay.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base64.hpp"
#include "embedded_files.hpp"
#include "film/creases.hpp"
#include "film/palette.hpp"

namespace innersphere::demo {
namespace {

using nlohmann::json;

constexpr int kRampSteps = 16;  // colours for radii

std::string cssColour(const Colour& colour) {
  char text[8];
  const auto byte = [](float v) {
    return static_cast<unsigned>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255));
  };
  std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(colour.r), byte(colour.g), byte(colour.b));
  return text;
}

std::string rampIndices(const std::vector<Sphere>& spheres) {
  const auto [least, most] = std::minmax_element(
      spheres.begin(), spheres.end(), [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
  const float largest = std::log(most->radius);
  const float range = std::max(largest - std::log(least->radius), 1e-6f);
  std::vector<std::uint8_t> indices;
  for (const Sphere& s : spheres) {
    const float value = 1 - (largest - std::log(s.radius)) / range;
    indices.push_back(static_cast<std::uint8_t>(std::lround(value * (kRampSteps - 1))));
  }
  return base64(indices);
}

json shapeJson(const Shape& shape, bool colour_by_radius) {
  json result = {{"name", shape.name}};
  if (!shape.surface.triangles.empty()) {
    const ShadedSurface shaded = splitCreases(shape.surface);
    result["vertices"] = base64(shaded.vertices);
    result["triangles"] = base64(shaded.triangles);
  }
  if (!shape.spheres.empty()) {
    result["spheres"] = base64(shape.spheres);
    if (colour_by_radius) result["sphere_colours"] = rampIndices(shape.spheres);
  }
  return result;
}

json viewpointJson(const Viewpoint& viewpoint) {
  return {{"azimuth", viewpoint.azimuth},
          {"elevation", viewpoint.elevation},
          {"field_of_view", viewpoint.field_of_view},
          {"whole_film", viewpoint.whole_film}};
}

json notesJson(const std::vector<Note>& notes) {
  json result = json::array();
  for (const Note& note : notes) {
    result.push_back({{"text", note.text}, {"holds", note.holds ? json(*note.holds) : json(nullptr)}});
  }
  return result;
}

json filmJson(const Film& film) {
  json result = {{"title", film.title},
                 {"caption", film.caption},
                 {"notes", notesJson(film.notes)},
                 {"frame_rate", film.frame_rate},
                 {"ground", film.has_ground ? json(film.ground) : json(nullptr)},
                 {"viewpoint", viewpointJson(film.viewpoint)}};
  for (int i = 0; i < kRampSteps; ++i) {
    result["ramp"].push_back(cssColour(rampColour(static_cast<float>(i) / (kRampSteps - 1))));
  }
  for (const Shape& shape : film.shapes) result["shapes"].push_back(shapeJson(shape, film.colour_by_radius));
  for (const Actor& actor : film.actors) {
    result["actors"].push_back({{"shape", actor.shape}, {"colour", cssColour(actor.colour)}});
  }
  static_assert(sizeof(Pose) == 7 * sizeof(float), "the page reads poses as seven numbers");
  result["poses"] = base64(film.poses);
  if (!film.contacts.empty()) {
    static_assert(sizeof(ContactMark) == 6 * sizeof(float), "the page reads contacts as six numbers");
    std::vector<ContactMark> marks;
    std::vector<std::uint32_t> first{0};
    for (const std::vector<ContactMark>& frame : film.contacts) {
      marks.insert(marks.end(), frame.begin(), frame.end());
      first.push_back(static_cast<std::uint32_t>(marks.size()));
    }
    result["contacts"] = base64(marks);
    result["first_contacts"] = base64(first);
  }
  return result;
}

std::string filmsText(const std::vector<Film>& films) {
  json result = json::array();
  for (const Film& film : films) result.push_back(filmJson(film));
  // Names come from users' files: no text of theirs may end the script element it stands in.
  std::string text = result.dump(-1, ' ', true, json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace

std::string replayPage(const std::vector<Film>& films) {
  const std::string data = filmsText(films);
  const std::pair<std::string_view, std::string_view> parts[] = {{"{{css}}", kPageCss},
                                                                 {"{{three}}", kThreeJs},
                                                                 {"{{controls}}", kOrbitControlsJs},
                                                                 {"{{films}}", data},
                                                                 {"{{page}}", kPageJs}};
  std::string page;
  std::string_view rest = kPageHtml;
  for (const auto& [name, text] : parts) {
    const std::size_t at = rest.find(name);
    page.append(rest.substr(0, at)).append(text);
    rest.remove_prefix(at + name.size());
  }
  return page.append(rest);
}

}  // namespace innersphere::demo
