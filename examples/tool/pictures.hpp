// Pictures and pages of films.
#pragma once

#include <string>

#include "command.hpp"
#include "film/film.hpp"
#include "render/renderer.hpp"

namespace innersphere::tool {

struct PictureArguments {
  std::string png;
  std::string html;
  demo::RenderOptions render;
};

/// Adds --png, --html and the size and kind of the picture.
void addPictureOptions(Command& command, PictureArguments& arguments);

/// Throws Error if an output exists and `force` is not set, cannot be written, or the ending of a picture is
/// not .png.
void checkPictures(const PictureArguments& arguments, bool force);

/// Writes what was asked for: a picture of the last frame, a page with all of them.
void writePictures(const demo::Film& film, const PictureArguments& arguments, bool force);

}  // namespace innersphere::tool
