#include "innersphere/packing_shape.hpp"
