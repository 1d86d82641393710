#include "innersphere/packing_collision_algorithm.hpp"
