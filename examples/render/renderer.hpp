// Draws a frame of a film on the CPU.
#pragma once

#include "film/film.hpp"
#include "image.hpp"
#include "innersphere/progress.hpp"

namespace innersphere::demo {

struct RenderOptions {
  int width = 1280;  ///< [pixels]
  int height = 720;  ///< [pixels]
  int samples = 24;  ///< rays through each pixel: more is smoother and as much slower
  View view = View::split;
};

/// A picture with soft shadows and one bounce of indirect light. The same bytes for any number of threads.
/// Throws Error cancelled.
Image render(const Film& film, std::size_t frame, const RenderOptions& options,
             const Progress& progress = {});

}  // namespace innersphere::demo
