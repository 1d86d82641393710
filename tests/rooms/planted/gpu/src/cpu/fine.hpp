#pragma once

#include "core/upward.hpp"
#include "innersphere/query.hpp"
