// An innersphere::Error becomes the Python exception that belongs to its code.
#include "bindings.hpp"

namespace innersphere::python {

void bindErrors() {
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const Error& error) {
      const nb::object exception = nb::module_::import_("innersphere._errors")
                                       .attr("exception_for")(toString(error.code()), error.what());
      PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
    }
  });
}

}  // namespace innersphere::python
