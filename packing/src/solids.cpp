#include "innersphere/solids.hpp"
