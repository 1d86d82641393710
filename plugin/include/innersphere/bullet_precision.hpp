// Bullet is built with float or with double scalars, and nothing in its libraries says which. The plug-in
// comes as two libraries, and its names live in a namespace that carries the precision, so that a program
// which mixes them does not link: the missing symbol then says "bullet_float32" or "bullet_float64".
#pragma once

#include <LinearMath/btScalar.h>

#ifdef BT_USE_DOUBLE_PRECISION
#define INNERSPHERE_BULLET_PRECISION bullet_float64
#else
#define INNERSPHERE_BULLET_PRECISION bullet_float32
#endif
