// From the triangles of a Bullet program to a model for PackingShape. modelFrom() needs InnerSphere::packer;
// the plug-in itself does not.
#pragma once

#include <memory>
#include <string>

#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/collision_model.hpp"
#include "innersphere/pack_mesh.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// The triangles of all sub-parts [m], scaled by getScaling(). Vertices may be PHY_FLOAT or PHY_DOUBLE,
/// indices PHY_INTEGER, PHY_SHORT or PHY_UCHAR, which are unsigned, as everywhere in Bullet. Throws Error
/// bad_argument: another type, a sub-part without arrays, or an index beyond its number of vertices.
Mesh meshFrom(const btStridingMeshInterface& triangles);

/// Packs the triangles, or reads what an earlier start of the program has packed, if options.cache_folder is
/// set: see packMesh(), whose errors it throws, too. The frame of the model is that of the triangles; see
/// PackingShape for what that means for bodies. Where a body was scaled before, scale either the triangles,
/// on each axis as you like, or, by one factor, the shape. A program that calls it links InnerSphere::packer.
///
///     innersphere::PackMeshOptions options;
///     options.cache_folder = innersphere::defaultCacheFolder();
///     innersphere::PackingShape shape(innersphere::modelFrom(triangles, "bunny", options));
inline std::shared_ptr<const CollisionModel> modelFrom(const btStridingMeshInterface& triangles,
                                                       const std::string& name,
                                                       const PackMeshOptions& options = {},
                                                       const Progress& progress = {}) {
  return std::make_shared<const CollisionModel>(
      std::make_shared<const Packing>(packMesh(meshFrom(triangles), name, options, progress)));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
