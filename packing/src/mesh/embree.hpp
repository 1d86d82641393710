// Includes Embree 3 or 4, whichever the system has: the point queries used here are the same in both.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
