// The summary of a scene.
#pragma once

#include <string>

#include "innersphere/contact_options.hpp"
#include "report.hpp"
#include "scenes/recording.hpp"

namespace innersphere::tool {

/// A line below the title of the film.
std::string captionOf(const demo::SceneWorld& world, double dt);

Report describe(const std::string& name, const demo::SceneWorld& world, const demo::Recording& recording,
                const ContactOptions& contact);

}  // namespace innersphere::tool
