// Small meshes that tests write to disk.
#pragma once

#include <string>

namespace innersphere::test {

/// A closed tetrahedron with edges of about 1 m.
inline const std::string kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// The same without its last side.
inline const std::string kOpenTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";

}  // namespace innersphere::test
