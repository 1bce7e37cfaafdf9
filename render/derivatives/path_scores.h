#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/spectrum.h"
#include "core/geometry/surfaces.h"
#include "core/geometry/textured_surfaces.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"
#include "core/paths/path_segment.h"

namespace uw {

/// A scene with one of its parameters decreased and increased for a central difference; one of the
/// two may be as it is. Both have the same constituents and emitters, in the same order, and
/// surfaces of the same shape, whose reflection may differ.
struct SceneChange {
    LitScene less, more;
    double step = 0;  // difference of the parameter between `more` and `less`, in its unit
};

/// A scene and its changes, prepared for PathScores. Thread safe.
class ChangedScenes {
  public:
    /// What the scenes refer to must outlive this object. Throws UsageError for changes that
    /// SceneChange does not allow.
    ChangedScenes(const LitScene& scene, std::span<const SceneChange> changes);

    std::size_t changes() const { return steps_.size(); }
    std::size_t bands() const { return bands_; }

  private:
    friend class PathScores;

    struct Side {
        explicit Side(const LitScene& of);

        LitScene scene;
        AttenuationTable attenuation;
        PhaseTable phases;
        // Whether these are those of the unchanged scene. Scattering: coefficients and phase
        // functions.
        bool has_same_attenuation = true, has_same_scattering = true, has_same_field = true,
             has_same_surfaces = true;
        std::vector<char> has_same_emitter;          // by emitter
        const TexturedSurfaces* textures = nullptr;  // of the surfaces, if there are any
    };

    /// Finds out which parts `side` has in common with the unchanged scene.
    void compare(Side& side) const;
    // Whether both sides of a change equal the unchanged scene in transmittance; in what happens to
    // light at a vertex of this kind; in an emitter.
    bool keeps_transmittance(std::size_t change) const;
    static bool keeps(const Side& side, PathVertex::Kind kind);
    bool keeps(std::size_t change, PathVertex::Kind kind) const {
        return keeps(less(change), kind) && keeps(more(change), kind);
    }
    bool keeps_emitter(std::size_t change, std::size_t emitter) const;

    const Side& base() const { return sides_.front(); }
    const Side& less(std::size_t change) const { return sides_[1 + 2 * change]; }
    const Side& more(std::size_t change) const { return sides_[2 + 2 * change]; }

    std::vector<Side> sides_;  // the base scene, then less and more of each change
    std::vector<double> steps_;
    std::vector<std::size_t> first_emitters_;  // the first emitter of each lamp
    std::size_t bands_ = 0, constituents_ = 0;
};

/// The relative change of a path's contribution with parameters of the scene: the score d
/// ln(radiance) / d parameter along a fixed path. The mean of radiance times score is the
/// derivative of the light, as the pdf of the path is divided out of its radiance. The derivative
/// by a parameter that moves a discontinuity (the edge of a shadow or of a beam) lacks that
/// boundary term.
///
/// Each factor of a path is differentiated by itself, as a central difference: e^-tau of its
/// segments, scattering coefficients times phase functions, BRDFs, and intensity, distance and
/// direction of the lamp, which may move. For one path after another, in one thread.
class PathScores {
  public:
    /// `scenes` must outlive this object.
    explicit PathScores(const ChangedScenes& scenes) : scenes_(scenes) {}

    /// Forgets all vertices.
    void begin() { count_ = 0; }
    /// As ContributionSink::add_vertex.
    int add_vertex(int before, const PathVertex& vertex);
    /// The changes `first`, `first + step`, ...; all of them by default.
    struct EveryFew {
        std::size_t first = 0, step = 1;
    };
    /// The scores of a contribution for these changes, [change * bands + band], in 1 / the
    /// parameter's unit.
    void find(const PathContribution& contribution, const EveryFew& which,
              std::span<double> scores);

  private:
    using Side = ChangedScenes::Side;

    // A vertex of a path. Storage is reused.
    struct Vertex {
        PathVertex::Kind kind = PathVertex::Kind::camera;
        Point3 position;
        Vector3 in{0, 0, 1};  // the direction from which the path arrives, as seen from the camera
        // By side: the base scene's, then those of all sides whose field or surfaces differ.
        std::vector<double> concentration;
        std::vector<SurfaceHit> hits;
        std::vector<double> scores;  // of the path up to here
    };
    Vertex& new_vertex();
    // `concentration`: at the vertex; if empty, it is looked up.
    void place(Vertex& vertex, PathVertex::Kind kind, const Point3& position, const SurfaceHit* hit,
               const Vertex* before, std::span<const double> concentration = {}) const;
    std::span<const double> concentrations(const Side& side, const Vertex& vertex) const;
    const SurfaceHit& hit(const Side& side, const Vertex& vertex) const;
    void add_transmittance(const Point3& from, const Point3& to, std::span<double> scores);
    void add_scattering(const Vertex& vertex, const Vector3& out, std::span<double> scores);
    void add_lamp(const PathContribution& contribution, std::span<double> scores);
    void add_emission(const Vertex& vertex, std::span<double> scores);
    void add_visible_lamp(std::size_t lamp, std::span<double> scores);
    void eval(const Side& side, const Vertex& vertex, const Vector3& out, Spectrum& values);
    // The light of an emitter at the last vertex.
    struct LampTerm {
        Vector3 to_lamp{};    // unit
        double distance = 0;  // that the light travelled [m]
        double light = 0;    // per intensity on the lamp's axis: relative intensity over distance^2
        Spectrum intensity;  // on the axis, by band
        Spectrum scattered;  // or reflected towards the camera, per light
        double value(std::size_t band) const { return light * intensity[band] * scattered[band]; }
    };
    // `base`: that of the unchanged scene, of which the term has what `side` does not change; null
    // for the unchanged scene itself.
    void eval_lamp(const Side& side, std::size_t emitter, const LampTerm* base, LampTerm& term);
    // Adds the score of the transmittance of an emitter's light over these distances; if the
    // contribution has columns, that of the whole path.
    void add_depth(const PathContribution& contribution, std::size_t change, double radius_less,
                   double radius_more, std::span<double> scores);
    Spectrum emission(const Side& side, const Vertex& vertex) const;
    void find_column(const Side& side, const Point3& from, const Point3& to,
                     std::vector<double>& column) const;
    // Adds (more - less) / (step * value) of what `find` evaluates for a side, except for changes
    // for which keeps(change) holds.
    template <class Keeps, class Find>
    void add_relative(const Keeps& keeps, const Find& find, std::span<double> scores);

    const ChangedScenes& scenes_;
    std::vector<Vertex> vertices_;
    std::size_t count_ = 0;  // of those in use
    EveryFew which_;         // the changes whose scores are computed
    Vertex last_;
    LampTerm lamp_, lamp_less_, lamp_more_;
    std::vector<double> column_, base_column_, less_, more_, p_;
};

}  // namespace uw
