#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace uw {

/// A rectangle of a lattice of nodes, by index.
struct NodeWindow {
    int i0 = 0, j0 = 0, i1 = 0, j1 = 0;  // [first, past the last)

    std::size_t size() const {
        return static_cast<std::size_t>(i1 - i0) * static_cast<std::size_t>(j1 - j0);
    }
};

/// Light at the nodes of a lattice, row by row, as two independent halves of its paths estimate it.
struct LatticeLight {
    int width = 0, height = 0;  // of the lattice [nodes]
    std::size_t values = 0;     // of a node: by group and band
    std::size_t bands = 0;
    std::vector<double> weights;  // by node, relative to others; 0: nothing is known there
    std::array<std::vector<float>, 2> halves;  // by node and value
    std::vector<float> band_weights;  // by node and band: what a band counts in the mean of all
    std::vector<float> variances;     // by node: of that mean of both halves
    std::vector<double> brightness;   // by node: what is all seen there, per weight

    LatticeLight(int columns, int rows, std::size_t values_of_node, std::size_t bands_of_node);
    std::size_t size() const { return weights.size(); }
    /// The values of one node in a half.
    std::span<float> of_node(std::size_t half, std::size_t node) {
        return std::span(halves[half]).subspan(node * values, values);
    }
};

/// What smoothing makes of it.
struct SmoothedLight {
    std::vector<char> is_known;    // by node: whether any node around it knows anything
    std::vector<float> light;      // by node and value
    std::vector<float> variances;  // that remain, by node and band
    /// By half, node and band: by how much the widest neighbourhoods changed the light. A change
    /// that is not noise is alike in both halves.
    std::array<std::vector<float>, 2> shifts;
};

/// The radius of the widest neighbourhood, and the distance of the farthest nodes on which a
/// smoothed node depends, in steps of the lattice.
inline constexpr int k_max_neighbourhood = 8, k_smoothing_reach = 12;

/// Smooths light by LatticeFit within ever wider neighbourhoods. Each moves the light towards the
/// wider fit by V / (V + B^2), the factor of the least squared error (Efron and Morris 1973): V is
/// the variance that the wider fit takes away, and B^2, the squared bias that it adds, the product
/// of the changes of both halves, whose noise is independent. B^2 is the median over the nodes next
/// to each other: a feature is seen by neighbours, too, while what a single node sees, a rare
/// bright path, is smoothed away, which else would stand as a spot. Nodes with far more noise than
/// those around them weigh less in their fits.
///
/// `takes_part(own, other, strictly)`: whether the fit of a node has another; those that take part
/// less strictly are used where there are no others. `belong(own, other)`: whether two nodes next
/// to each other decide together. Nothing is known outside `window`. Thread safe.
SmoothedLight smooth(
    const LatticeLight& light, const NodeWindow& window,
    const std::function<bool(std::size_t own, std::size_t other, bool strictly)>& takes_part,
    const std::function<bool(std::size_t own, std::size_t other)>& belong);

}  // namespace uw
