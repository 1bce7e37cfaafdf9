#pragma once

#include <cstddef>
#include <span>

#include "core/surfaces/embree_callbacks.h"

/// Sends queries through Embree, one at a time or as packets of rays that go much the same way; for
/// embree_*.cpp only.
///
/// All ways find every triangle that a ray meets well inside (TriangleCrossing), with equal numbers
/// to the bit. Near an edge, though, it is rounding that decides whether a ray comes into the boxes
/// around a triangle, and each way rounds differently; a packet also tries a ray on what is in the
/// boxes of its neighbours only. What is met near an edge is therefore decided by one way alone: a
/// packet of one ray. As it meets nothing that a larger packet with that ray would miss, the
/// results are those of single queries even where a packet meets nothing at all.
namespace uw {

/// The most queries a packet holds.
inline constexpr std::size_t k_packet_size = 8;

/// Looks for the nearest candidate of `query` between the parameters `begin` and `end`.
void trace(RTCScene scene, Query& query, float begin, double end);
/// The same as a packet of one.
void trace_edges(RTCScene scene, Query& query, float begin, double end);
/// The same for a packet, from 0 to the end of each.
void trace_packet(RTCScene scene, std::span<Query> queries, std::span<const double> ends);

/// Whether, all edges decided, a mesh or sphere stands between the parameters 0 and 1.
bool is_occluded(RTCScene scene, Query& query);
/// The same for a packet: bit i of the result is that of query i.
unsigned occluded_packet(RTCScene scene, std::span<Query> queries);

}  // namespace uw
