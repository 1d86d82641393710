// A film as a page that a browser plays.
#pragma once

#include <string>
#include <vector>

#include "film/film.hpp"

namespace innersphere::demo {

/// The text of one HTML page that plays films, at least one, and carries everything it needs, three.js
/// included: it opens from a file, without a server and without a network.
/// `#film=2&t=2.5&paused&view=spheres` behind its address jumps to a film (counted from 0), a moment and a
/// view: surface, spheres, both or contacts. An open page follows such a link, too; what a link does not name
/// stays as it is. Without `paused` films play in a loop, as soon as the first picture is there.
std::string replayPage(const std::vector<Film>& films);

}  // namespace innersphere::demo
