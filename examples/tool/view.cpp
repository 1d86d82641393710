#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>
#include <variant>

#include "commands.hpp"
#include "coverage_film.hpp"
#include "exit_codes.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "inputs.hpp"
#include "pictures.hpp"
#include "report.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

enum class Colouring { radius, coverage };

struct Arguments {
  std::string source;
  std::size_t spheres = 2000;
  bool y_up = false;
  Colouring colour = Colouring::radius;
  PictureArguments pictures;
  bool force = false;
};

// The file's name, or the solid's with a capital letter.
std::string titleOf(const std::string& source) {
  std::string title = std::filesystem::path(source).filename().string();
  if (!std::filesystem::exists(source)) title[0] = static_cast<char>(std::toupper(title[0]));
  return title;
}

std::string captionOf(const Packing& packing) {
  return std::to_string(packing.spheres.size()) + " spheres fill " + percent(packing.quality.density) +
         " of it. ";
}

std::string captionOf(const Covering& covering) {
  std::string caption = std::to_string(covering.spheres.size()) + " spheres that overlap ";
  caption +=
      covering.kind == CoveringKind::clump ? "hold " + percent(covering.inside) + " of it" : "contain it";
  return caption + " and reach out by up to " + number(covering.overhang_max, "m") + ". ";
}

demo::Film filmOf(const Packing& packing, const std::string& title, const std::string& caption, bool y_up,
                  Colouring colour) {
  demo::Film film;
  film.title = title;
  film.caption = caption;
  if (colour == Colouring::coverage) {
    film.caption += addCoverage(packing, film);
  } else {
    const auto [least, most] =
        std::minmax_element(packing.spheres.begin(), packing.spheres.end(),
                            [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
    film.caption += "The colours of the spheres show their radius, " + number(least->radius) + " to " +
                    number(most->radius, "m") + ".";
    film.colour_by_radius = true;
    film.shapes.push_back({title, packing.surface, packing.spheres});
    film.actors.push_back({0, demo::paletteColour(1)});
  }
  // A quarter turn about x takes y to z.
  const float half = std::sqrt(0.5f);
  demo::Pose pose;
  if (y_up) pose.rotation = {half, 0, 0, half};
  film.poses.assign(film.actors.size(), pose);
  const auto height = [y_up](float y, float z) { return y_up ? y : z; };
  film.ground = std::numeric_limits<float>::max();
  for (const Sphere& s : packing.spheres) film.ground = std::min(film.ground, height(s.y, s.z) - s.radius);
  for (const auto& v : packing.surface.vertices) film.ground = std::min(film.ground, height(v[1], v[2]));
  return film;
}

void run(Arguments& arguments) {
  PictureArguments& pictures = arguments.pictures;
  const std::string stem = stemOf(arguments.source);
  if (pictures.png.empty() && pictures.html.empty()) {
    pictures.png = stem + ".png";
    pictures.html = stem + ".html";
  }
  if (arguments.colour == Colouring::coverage) pictures.render.view = demo::View::surface;
  checkPictures(pictures, arguments.force);
  std::variant<Packing, Covering> loaded;
  if (isPacking(arguments.source)) {
    loaded = loadSpheres(arguments.source);
  } else {
    loaded = loadOrPack(arguments.source, arguments.spheres);
  }
  const std::string caption = std::visit([](const auto& spheres) { return captionOf(spheres); }, loaded);
  Packing packing;
  if (Covering* covering = std::get_if<Covering>(&loaded)) {
    packing.spheres = std::move(covering->spheres);
    pictures.render.view = demo::View::spheres;  // all that there is
  } else {
    packing = std::get<Packing>(std::move(loaded));
  }
  say(arguments.y_up ? "the y axis points up; --up z turns that" : "the z axis points up; --up y turns that");
  writePictures(filmOf(packing, titleOf(arguments.source), caption, arguments.y_up, arguments.colour),
                pictures, arguments.force);
}

}  // namespace

Command viewCommand() {
  Command command("view", "Show a packing: its surface, and its spheres coloured by radius");
  auto arguments = std::make_shared<Arguments>();
  command
      .argument("FILE", arguments->source,
                "Packing file, covering or clump, or a mesh or a solid's name to pack first; -: stdin")
      .withFile()
      .withSuggestions(namedSolids());
  command.count("--spheres", arguments->spheres, {1}, "Of what is packed first");
  command.choice<bool>("--up", arguments->y_up, {{"y", true}, {"z", false}}, "Axis that points up");
  command.choice<Colouring>("--colour", arguments->colour,
                            {{"radius", Colouring::radius}, {"coverage", Colouring::coverage}},
                            "Spheres by their radius, or the surface by its distance to the nearest sphere");
  addPictureOptions(command, arguments->pictures);
  command.flag("--force", arguments->force, "Replace existing outputs");
  command.notes =
      "Without --png and --html both are written to the current folder, named after FILE. The picture takes "
      "some 10 s of a core, the page none: --samples, --width and --height make it quick.";
  command.examples = {"innersphere view bunny.cbor --up y", "innersphere view gear --html gear.html",
                      "innersphere view cup.cbor --colour coverage --png cup.png"};
  command.run = [arguments] {
    run(*arguments);
    return kOk;
  };
  return command;
}

}  // namespace innersphere::tool
