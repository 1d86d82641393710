// What the colours of a picture mean.
#pragma once

#include "film/film.hpp"
#include "render/image.hpp"

namespace innersphere::demo {

/// Draws the film's scale, if it has one, into the lower left corner: a row of colours, and the value between
/// each two. Pictures too narrow for it stay as they are.
void drawLegend(const Film& film, Image& image);

}  // namespace innersphere::demo
