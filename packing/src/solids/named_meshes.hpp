// Makes the meshes of the named solids: closed, wound outwards, free of self-intersections.
#pragma once

#include "innersphere/mesh.hpp"

namespace innersphere {

Mesh linkMesh();
Mesh bowlMesh();
Mesh gearMesh();
Mesh lbracketMesh();
Mesh trayMesh();
Mesh knotMesh();
Mesh nutMesh();
Mesh boltMesh();
Mesh chazelleMesh();
Mesh cupMesh();
Mesh panMesh();
Mesh bladeMesh();
Mesh hornMesh();

/// Returns Chazelle's polyhedron with this many wedges from below and from above.
Mesh wedgedCube(int wedges);

}  // namespace innersphere
