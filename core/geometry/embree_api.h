#pragma once

/// Embree 3 and 4 behind one set of calls; for embree_*.h and embree_*.cpp only. Embree 4 moved the
/// flags of a query from its context into a separate arguments struct; everything else used here
/// has kept its name and meaning. cmake/ThirdParty.cmake prefers Embree 4 in the same way.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace uw::embree {

#if RTC_VERSION_MAJOR >= 4

/// Passed by a query to its callbacks. A struct that begins with one can pass more data.
using Context = RTCRayQueryContext;

/// An initialised context.
inline Context make_context() {
    Context context{};
    rtcInitRayQueryContext(&context);
    return context;
}

/// Looks for the closest hit of one ray.
inline void intersect1(RTCScene scene, Context& context, RTCRayHit& rayhit) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &rayhit, &arguments);
}

/// The same for up to 8 rays with similar directions: those whose `valid` is -1, not 0.
inline void intersect8(const int* valid, RTCScene scene, Context& context, RTCRayHit8& rayhits) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    arguments.context = &context;
    rtcIntersect8(valid, scene, &rayhits, &arguments);
}

/// Looks for any occluder of one ray; sets its tfar to minus infinity if there is one.
inline void occluded1(RTCScene scene, Context& context, RTCRay& ray) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    rtcOccluded1(scene, &ray, &arguments);
}

/// The same for up to 8 rays with similar directions: those whose `valid` is -1, not 0.
inline void occluded8(const int* valid, RTCScene scene, Context& context, RTCRay8& rays) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    arguments.context = &context;
    rtcOccluded8(valid, scene, &rays, &arguments);
}

#else

using Context = RTCIntersectContext;

inline Context make_context() {
    Context context{};
    rtcInitIntersectContext(&context);
    return context;
}

inline void intersect1(RTCScene scene, Context& context, RTCRayHit& rayhit) {
    rtcIntersect1(scene, &context, &rayhit);
}

inline void intersect8(const int* valid, RTCScene scene, Context& context, RTCRayHit8& rayhits) {
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &context, &rayhits);
}

inline void occluded1(RTCScene scene, Context& context, RTCRay& ray) {
    rtcOccluded1(scene, &context, &ray);
}

inline void occluded8(const int* valid, RTCScene scene, Context& context, RTCRay8& rays) {
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(valid, scene, &context, &rays);
}

#endif

}  // namespace uw::embree
