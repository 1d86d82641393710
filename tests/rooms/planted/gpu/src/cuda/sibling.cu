#include "core/upward.hpp"
#include "cpu/fine.hpp"
