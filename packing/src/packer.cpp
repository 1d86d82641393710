#include "innersphere/packer.hpp"
#include <stdexcept>
namespace innersphere { Packing pack(const Solid&, const PackOptions&, const Progress&) { throw std::logic_error("unfinished"); } }
