#pragma once

#include "cpu/fine.hpp"
