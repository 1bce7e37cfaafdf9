#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/image/film.h"
#include "core/light/integrator.h"
#include "core/light/lamp.h"
#include "core/light/medium.h"
#include "core/passes/pixel_view.h"

namespace uw {

/// A rectangle of the image [pixels].
struct ImageRectangle {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Detects beams of lamps that are narrow in the image, such as a laser's: they may lie between
/// rays that are some pixels apart. A pattern is so everywhere in its beam, a sheet of light where
/// rays lie in its plane.
class FineBeams {
  public:
    /// `rays` must outlive this object.
    FineBeams(const RaySource& rays, const std::vector<Lamp>& emitters);

    /// Prepares calls of has_any() for parts of `area`, `width` at most, and distances up to
    /// `max_distance` [m].
    void begin(const ImageRectangle& area, double width, double max_distance);

    /// Whether a beam that is narrower than `width` pixels is visible in `area`, or may be, up to
    /// the maximum distance of begin().
    bool has_any(const ImageRectangle& area, double width) const;

  private:
    /// A cone in which the intensity exceeds half of its maximum, in one in which it matters.
    struct Beam {
        Point3 apex;
        Vector3 axis;                    // unit
        double core_slope, outer_slope;  // tangents of the angles from the axis
        bool is_wide;                    // the outer cone is too wide to be one in the image
        FineStructure fine;
    };
    /// The pyramid of the rays of a rectangle.
    struct Bundle {
        Point3 origin;
        Vector3 direction;                // of the ray in the middle
        std::array<Vector3, 4> outwards;  // normals of its sides
        std::array<double, 4> offsets;    // inside: dot(outwards, x) <= offset
        std::array<Vector3, 4> corners;   // directions of the rays at its corners
        double pixel = 0;                 // width of a pixel, per metre of distance
    };

    static std::optional<Beam> beam_of(const Lamp& emitter);
    std::optional<Bundle> bundle(const ImageRectangle& area) const;
    bool is_fine_in(const Bundle& bundle, const Beam& beam, double width) const;
    static bool may_lie_in_sheet(const Bundle& bundle, const Vector3& normal);

    const RaySource& rays_;
    std::vector<Beam> beams_;
    std::vector<const Beam*> near_;  // those that may matter in the area of begin()
    double max_distance_ = 0;
};

/// Detects clouds of particles that are small in the image: rays that are some pixels apart may
/// miss them. Probes find them: rays k_spacing pixels apart, or twice that in an even haze, along
/// which only the optical depth of the particles is computed.
class FineParticles {
  public:
    static constexpr int k_spacing = 2;  // [pixels]

    /// `rays` and `scene` must outlive this object.
    FineParticles(const RaySource& rays, const LitScene& scene);

    /// Prepares a tile, whose probes are computed up to `max_distance` [m] when they are first
    /// needed. `edge` [pixels]: that of a whole tile, which may extend beyond the image.
    void begin(const PixelWindow& tile, int edge, double max_distance);

    /// Whether the square of `size` pixels at (i, j) of the tile contains particles that
    /// interpolation between rays at multiples of `spacing` misses. All arguments are multiples of
    /// k_spacing.
    bool has_any(int i, int j, int size, int spacing);

  private:
    /// Pixels of the tile.
    struct Square {
        int x, y, width, height;
    };

    double attenuated(int i, int j);
    Interval range(const Square& square, int step);
    // Whether a probe differs by more than `allowed` from interpolation between rays `spacing`
    // apart.
    bool differs(const Square& square, int step, int spacing, double allowed);

    const RaySource& rays_;
    const ConcentrationField* field_;
    AttenuationTable attenuation_;
    double max_distance_ = 0;
    PixelWindow tile_;
    // Fraction of light that the particles along a probe attenuate, mean over the bands; < 0: not
    // yet computed.
    Grid2D<double> attenuated_;
    std::vector<double> column_;
};

/// Interpolates the in-scattered light of a tile of pixels. That light varies smoothly across the
/// image except at the edges of shadows and surfaces, so it is integrated at the nodes of a lattice
/// and interpolated between them, bilinearly over the image and by a parabola over distance. Where
/// the nodes of the next finer lattice do not confirm the interpolation, the lattice is refined,
/// down to single pixels. Shadows in the water that are narrower than the distance between nodes
/// may be missed. Reused between tiles.
class InScatterLattice {
  public:
    /// Pixels along a tile's edge. Tiles are aligned to multiples of it in the full image, so that
    /// a window has the same pixels as the whole image.
    static constexpr int k_tile = 32;

    /// `tolerance`: the maximum relative difference between the interpolated and the integrated
    /// value halfway between nodes of the coarsest lattice; for each finer lattice, sqrt(2) times
    /// that of the one before. Pixels are interpolated from the halfway nodes as well, so their
    /// error is smaller. All references must outlive this object.
    InScatterLattice(const RaySource& rays, const LitScene& scene, const RayInScatter& in_scatter,
                     double tolerance);

    /// Computes the in-scattered light of the pixels of `tile` (k_tile along an edge, less at the
    /// image's right and bottom). `views`, those of these pixels, must stay valid while the values
    /// are used. `other_light`: the least light, by band, that is added to these values in any
    /// pixel; the tolerance is relative to the sum.
    void evaluate(const PixelWindow& tile, const Grid2D<PixelView>& views,
                  std::span<const double> other_light);
    /// Sets `least` to the minimum over the tile's pixels of the sum over all groups, by band.
    void find_least(std::span<double> least) const;

    /// The values (RayInScatter) of one pixel of the tile, which has this index in `views`; zeros
    /// where no ray enters the water.
    std::span<const double> values(std::size_t pixel) const {
        return std::span(pixel_values_).subspan(pixel * value_count_, value_count_);
    }

  private:
    static constexpr int k_coarsest = 32, k_finest = 2;  // spacings of the lattices [pixels]
    static constexpr int k_side = k_tile / k_finest + 1;
    static constexpr std::size_t k_stops = 3;   // distances that define a parabola
    static constexpr std::size_t k_depths = 3;  // maximum number of surfaces around a node

    /// A range of distances so narrow that a parabola through the light up to its least, middle and
    /// greatest one gives that up to any of them.
    struct Depth {
        double least = 0, greatest = 0;
        bool alike() const { return greatest <= (1 + 1e-9) * least; }
        std::size_t stops() const { return alike() ? 1 : k_stops; }
        double middle() const { return 0.5 * (least + greatest); }
    };
    /// A ray of the lattice, integrated when it is first needed.
    struct Node {
        enum class State { unknown, ready, unusable } state = State::unknown;
        int radius = 0;  // within which its depths cover those of all pixels [pixels]
        std::size_t depth_count = 0;
        std::array<Depth, k_depths> depths{};
        std::size_t values = 0;  // index in node_values_ of the first stop of the first depth
    };
    using Corners = std::array<const Node*, 4>;
    struct Place;

    const Node& node(int i, int j);
    void find_depths(int i, int j, Node& node) const;
    bool include(double distance, Node& node) const;
    bool integrate_node(int i, int j, Node& node);
    // Finds the four nodes around the cell at (i, j); false if one of them cannot be used there.
    bool corners(int i, int j, int spacing, Corners& found);
    // Whether interpolation between the cell's corners agrees with integration at the nodes halfway
    // between them.
    bool confirmed(int i, int j, int spacing);
    // Returns the pixels of a cell, including those of all its nodes in the tile.
    ImageRectangle cell(int i, int j, int spacing) const;
    // Whether something narrow may lie between these nodes.
    bool has_fine(int i, int j, int spacing);
    bool agree(const Corners& from, const Place& place, const Node& node, double allowed);
    void collect_distances();
    void fill_cell(int i, int j, int spacing);
    void fill_pixel(int x, int y, int spacing);
    void set_floor();
    // Returns false if one of the distances lies outside all depths of the node.
    bool add_node(const Node& node, double weight, std::span<const double> distances,
                  std::span<const double> weights, std::span<double> values) const;

    const RaySource& rays_;
    const RayInScatter& in_scatter_;
    double tolerance_;
    double max_relative_width_;  // of a Depth
    std::size_t value_count_;

    FineBeams beams_;
    FineParticles particles_;
    PixelWindow tile_;
    const Grid2D<PixelView>* views_ = nullptr;
    std::vector<double> distances_;             // of all views, one after another
    std::vector<std::size_t> first_distances_;  // index in distances_ for each view, then the total
    std::vector<double> pixel_values_;          // pixel by pixel
    Grid2D<Node> nodes_;
    std::vector<double> node_values_;
    std::vector<double> floor_;  // per band: minimum to which errors are relative [W m^-2 sr^-1]
    std::vector<double> other_light_;  // per band
    std::vector<double> interpolated_, integrated_;
};

}  // namespace uw
