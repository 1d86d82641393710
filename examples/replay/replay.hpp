// A film as a page that a browser plays.
#pragma once

#include <string>

#include "film/film.hpp"

namespace innersphere::demo {

/// The text of one HTML page that carries everything it needs, three.js included: it opens from a file,
/// without a server and without a network. `#t=2.5&paused&view=spheres` behind its address jumps to a moment
/// and a view.
std::string replayPage(const Film& film);

}  // namespace innersphere::demo
