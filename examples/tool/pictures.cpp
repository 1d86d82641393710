#include "pictures.hpp"

#include "file_names.hpp"
#include "innersphere/error.hpp"
#include "outputs.hpp"
#include "render/legend.hpp"
#include "replay/replay.hpp"
#include "terminal.hpp"

namespace innersphere::tool {

void addPictureOptions(Command& command, PictureArguments& arguments) {
  using demo::View;
  command.text("--png", arguments.png, "Write a picture").withFile();
  command.text("--html", arguments.html, "Write a page that shows it in a browser, without a server")
      .withFile();
  command.choice<View>("--show", arguments.render.view,
                       {{"surface", View::surface}, {"spheres", View::spheres}, {"split", View::split}},
                       "What the picture shows; split: surfaces on its left, spheres on its right");
  command.count("--width", arguments.render.width, {16, 16384}, "Of the picture [pixels]");
  command.count("--height", arguments.render.height, {16, 16384}, "Of the picture [pixels]");
  command.count("--samples", arguments.render.samples, {1, 65536},
                "Rays a pixel: twice as many take twice the time and are smoother; 4 are a quick look");
}

void checkPictures(const PictureArguments& arguments, bool force) {
  const std::string& png = arguments.png;
  if (!png.empty() && !isStream(png) && endingOf(png) != ".png") {
    throw Error(ErrorCode::bad_argument, "a picture is written to .png, not to " + png);
  }
  checkOutput(arguments.png, force);
  checkOutput(arguments.html, force);
}

void writePictures(const demo::Film& film, const PictureArguments& arguments, bool force) {
  if (!arguments.html.empty()) {
    writeTextOutput(arguments.html, force, demo::replayPage({film}));
    say("wrote " + arguments.html);
  }
  if (!arguments.png.empty()) {
    demo::Image image = demo::render(film, film.frames() - 1, arguments.render, progressBar());
    drawLegend(film, image);
    // The picture has no words.
    if (!film.scale.empty()) say(film.caption);
    writeOutput(arguments.png, force, [&image](const std::string& path) { demo::writePng(image, path); });
    say("wrote " + arguments.png);
  }
}

}  // namespace innersphere::tool
