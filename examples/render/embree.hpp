// Embree 3 (Debian 12) and Embree 4 (Ubuntu 24.04) differ in the names of the header and of the ray
// arguments.
#pragma once

#if INNERSPHERE_EMBREE_VERSION >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace innersphere::demo {

inline void intersectRay(RTCScene scene, RTCRayHit& ray) {
#if INNERSPHERE_EMBREE_VERSION >= 4
  rtcIntersect1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
#endif
}

inline void occludeRay(RTCScene scene, RTCRay& ray) {
#if INNERSPHERE_EMBREE_VERSION >= 4
  rtcOccluded1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace innersphere::demo
