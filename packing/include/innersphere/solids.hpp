// Makes the project's own solids, so that demos and tests need no mesh files.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "innersphere/solid.hpp"

namespace innersphere {

// These solids have an exact distance. Their makers throw Error bad_argument where a length is not > 0.

/// Makes a ball with its centre at the origin [m].
std::unique_ptr<Solid> makeBall(double radius);
/// Makes a box around the origin whose edges have these full lengths [m].
std::unique_ptr<Solid> makeBox(const Vec3d& size);
/// Makes a torus around the origin whose ring lies about the z axis [m].
std::unique_ptr<Solid> makeTorus(double ring_radius, double tube_radius);
/// Makes a cylinder around the origin along the z axis, of this full height [m].
std::unique_ptr<Solid> makeCylinder(double radius, double height);

/// Makes a solid from a signed distance, which is negative and exact inside. Outside it may be too small.
/// Mass properties are found by sampling the box `bounds`, which has to hold the solid, at `resolution` cells
/// (1 to 1024) along its longest side, to a relative error of about 1 / resolution^2 for smooth shapes; the
/// surface at half the resolution, with rounded edges. Throws Error: bad_argument (bounds, resolution, no
/// function), not_a_solid (the distance is negative nowhere).
std::unique_ptr<Solid> makeDistanceSolid(const std::string& name,
                                         std::function<double(const Vec3d&)> signed_distance,
                                         const Bounds& bounds, int resolution = 128);

/// Makes the solid of all points in `a` and not in `b`. Distances from the inside are exact: the nearest
/// point of either surface is on the boundary of the difference. Mass properties and surface are sampled as
/// above, at 128. Throws Error: bad_argument (a null solid), not_a_solid (nothing is left).
std::unique_ptr<Solid> makeDifference(std::shared_ptr<const Solid> a, std::shared_ptr<const Solid> b);

/// Makes a named solid of the project with sizes that suit a scene about 1 m wide: ball, box, cylinder,
/// torus, link (of a chain), bowl, gear, lbracket, knot, nut, bolt, chazelle, tray, cup, pan, blade, horn.
/// Throws Error bad_argument for an unknown name; the message lists the known ones.
///
/// Nut and bolt mate. Both are about the z axis with a right-handed thread of pitch 0.125; the bolt's thread
/// runs from its head at z = 0 up to 0.75, the nut is 0.375 high and stands on z = 0. The nut fits, with 0.01
/// of radial clearance, where it is moved up by h and turned by 2 pi h / 0.125 counter-clockwise seen from
/// above. The tray is an open container, 2 x 2 x 1, standing on z = 0, with walls and a floor of 0.2.
/// Cup, pan and blade have walls of less than 0.01, for which PackOptions::order should be
/// SphereOrder::coverage; the horn is a bent cone.
std::unique_ptr<Solid> makeNamedSolid(const std::string& name);
/// Returns the names that makeNamedSolid() knows.
std::vector<std::string> namedSolids();

}  // namespace innersphere
