// Makes ball, box, torus and cylinder with a name of one's choice.
#pragma once

#include <memory>
#include <string>

#include "innersphere/solid.hpp"

namespace innersphere {

std::unique_ptr<Solid> ballSolid(const std::string& name, double radius);
std::unique_ptr<Solid> boxSolid(const std::string& name, const Vec3d& size);
std::unique_ptr<Solid> torusSolid(const std::string& name, double ring_radius, double tube_radius);
std::unique_ptr<Solid> cylinderSolid(const std::string& name, double radius, double height);

}  // namespace innersphere
