#include "pictures.hpp"

#include "choice.hpp"
#include "outputs.hpp"
#include "replay/replay.hpp"
#include "terminal.hpp"

namespace innersphere::tool {

void addPictureOptions(CLI::App& command, PictureArguments& arguments) {
  using demo::View;
  command.add_option("--png", arguments.png, "Write a picture");
  command.add_option("--html", arguments.html, "Write a page that shows it in a browser, without a server");
  addChoice<View>(command, "--show", arguments.render.view,
                  {{"surface", View::surface}, {"spheres", View::spheres}, {"split", View::split}},
                  "What the picture shows; split: surfaces on its left, spheres on its right");
  command.add_option("--width", arguments.render.width, "Of the picture [pixels]")
      ->check(CLI::Range(16, 16384))
      ->capture_default_str();
  command.add_option("--height", arguments.render.height, "Of the picture [pixels]")
      ->check(CLI::Range(16, 16384))
      ->capture_default_str();
  command.add_option("--samples", arguments.render.samples, "Rays a pixel: more is smoother and slower")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
}

void checkPictures(const PictureArguments& arguments, bool force) {
  checkOutput(arguments.png, force);
  checkOutput(arguments.html, force);
}

void writePictures(const demo::Film& film, const PictureArguments& arguments, bool force) {
  if (!arguments.html.empty()) {
    writeTextOutput(arguments.html, force, demo::replayPage({film}));
    say("wrote " + arguments.html);
  }
  if (!arguments.png.empty()) {
    const demo::Image image = demo::render(film, film.frames() - 1, arguments.render, progressBar());
    writeOutput(arguments.png, force, [&image](const std::string& path) { demo::writePng(image, path); });
    say("wrote " + arguments.png);
  }
}

}  // namespace innersphere::tool
