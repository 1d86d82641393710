#include "innersphere/query.hpp"
