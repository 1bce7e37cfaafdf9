#pragma once

#include <cstddef>
#include <span>

#include "core/embree_callbacks.h"

/// Sends queries through Embree, one at a time or as packets of rays that go much the same way,
/// with equal results; for embree_*.cpp only.
namespace uw {

/// The most queries a packet holds.
inline constexpr std::size_t k_packet_size = 8;

/// Looks for the nearest candidate of `query` between the parameters `begin` and `end`.
void trace(RTCScene scene, Query& query, float begin, double end);
/// The same for a packet, from 0 to the end of each.
void trace_packet(RTCScene scene, std::span<Query> queries, std::span<const double> ends);

/// Whether a mesh or sphere stands between the parameters 0 and 1.
bool is_occluded(RTCScene scene, Query& query);
/// The same for a packet: bit i of the result is that of query i.
unsigned occluded_packet(RTCScene scene, std::span<Query> queries);

}  // namespace uw
