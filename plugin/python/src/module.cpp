// The compiled half of the Python package; plugin/python/innersphere is the other.
#include "bindings.hpp"

NB_MODULE(_core, module) {
  module.doc() = "The compiled half of innersphere. Import innersphere instead.";
  module.attr("__version__") = INNERSPHERE_VERSION;
  innersphere::python::bindErrors();
  innersphere::python::bindPacking(module);
  innersphere::python::bindOverlaps(module);
#ifdef INNERSPHERE_PYBULLET
  innersphere::python::bindPyBullet(module);
#endif
}
