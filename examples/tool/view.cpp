#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include "choice.hpp"
#include "commands.hpp"
#include "film/palette.hpp"
#include "innersphere/packer.hpp"
#include "inputs.hpp"
#include "numbers.hpp"
#include "pictures.hpp"
#include "report.hpp"

namespace innersphere::tool {
namespace {

struct Arguments {
  std::string source;
  std::size_t spheres = 2000;
  bool y_up = false;
  PictureArguments pictures;
  bool force = false;
};

// The file's name, or the solid's with a capital letter.
std::string titleOf(const std::string& source) {
  std::string title = std::filesystem::path(source).filename().string();
  if (!std::filesystem::exists(source)) title[0] = static_cast<char>(std::toupper(title[0]));
  return title;
}

demo::Film filmOf(const Packing& packing, const std::string& title, bool y_up) {
  demo::Film film;
  film.title = title;
  film.caption = std::to_string(packing.spheres.size()) + " spheres fill " +
                 percent(packing.quality.density) + " of it. Colours show the radius, " +
                 number(packing.spheres.back().radius) + " to " +
                 number(packing.spheres.front().radius, "m") + ".";
  film.colour_by_radius = true;
  film.shapes.push_back({title, packing.surface, packing.spheres});
  film.actors.push_back({0, demo::paletteColour(1)});
  // A quarter turn about x takes y to z.
  const float half = std::sqrt(0.5f);
  demo::Pose pose;
  if (y_up) pose.rotation = {half, 0, 0, half};
  film.poses.push_back(pose);
  const auto height = [y_up](float y, float z) { return y_up ? y : z; };
  film.ground = std::numeric_limits<float>::max();
  for (const Sphere& s : packing.spheres) film.ground = std::min(film.ground, height(s.y, s.z) - s.radius);
  for (const auto& v : packing.surface.vertices) film.ground = std::min(film.ground, height(v[1], v[2]));
  return film;
}

void run(Arguments& arguments) {
  PictureArguments& pictures = arguments.pictures;
  const std::string stem = std::filesystem::path(arguments.source).stem().string();
  if (pictures.png.empty() && pictures.html.empty()) {
    pictures.png = stem + ".png";
    pictures.html = stem + ".html";
  }
  checkPictures(pictures, arguments.force);
  const Packing packing = loadOrPack(arguments.source, arguments.spheres);
  writePictures(filmOf(packing, titleOf(arguments.source), arguments.y_up), pictures, arguments.force);
}

}  // namespace

void addViewCommand(CLI::App& app, Session&) {
  CLI::App* command =
      app.add_subcommand("view", "Show a packing: its surface, and its spheres coloured by radius");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("FILE", arguments->source, "Packing file, or a mesh or a solid's name to pack first")
      ->required();
  command->add_option("--spheres", arguments->spheres, "Of what is packed first")
      ->check(positive())
      ->capture_default_str();
  addChoice<bool>(*command, "--up", arguments->y_up, {{"y", true}, {"z", false}}, "Axis that points up");
  addPictureOptions(*command, arguments->pictures);
  command->add_flag("--force", arguments->force, "Replace existing outputs");
  command->footer(
      "Without --png and --html both are written to the current folder, named after FILE.\nExamples:\n"
      "  innersphere view bunny.cbor --up y\n"
      "  innersphere view gear --html gear.html");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace innersphere::tool
