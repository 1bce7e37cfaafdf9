#pragma once

#include <cstddef>
#include <span>

#include "core/surfaces/embree_callbacks.h"

/// Traces queries with Embree, one at a time or as packets of coherent rays; for embree_*.cpp only.
///
/// All variants find every triangle that a ray hits well inside (TriangleCrossing), with
/// bit-identical results. Near an edge, however, rounding decides whether a ray enters the boxes
/// around a triangle, and each variant rounds differently; a packet also tests a ray against
/// triangles in boxes that only its neighbours enter. Hits near an edge are therefore decided by a
/// single variant: a packet of one ray. As it hits nothing that a larger packet with that ray would
/// miss, the results equal those of single queries even where a packet hits nothing at all.
namespace uw {

/// The most queries a packet holds.
inline constexpr std::size_t k_packet_size = 8;

/// Finds the nearest candidate of `query` between the parameters `begin` and `end`.
void trace(const TracedScene& traced, Query& query, float begin, double end);
/// The same as a packet of one.
void trace_edges(const TracedScene& traced, Query& query, float begin, double end);
/// The same for a packet, from 0 to the end of each.
void trace_packet(const TracedScene& traced, std::span<Query> queries,
                  std::span<const double> ends);

/// Whether a mesh or sphere lies between the parameters 0 and 1, with hits near edges resolved.
bool is_occluded(const TracedScene& traced, Query& query);
/// The same for a packet: bit i of the result is that of query i.
unsigned occluded_packet(const TracedScene& traced, std::span<Query> queries);

}  // namespace uw
