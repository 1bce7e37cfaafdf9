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

/// A scene with one of its numbers a little less and a little more than it is, or as it is: of the
/// same constituents and emitters, in the same order, and of surfaces of the same shape, which may
/// reflect otherwise.
struct SceneChange {
    LitScene less, more;
    double step = 0;  // by how much the number differs between the two, in its unit
};

/// A scene and its changes, as scores look them up. Thread safe.
class ChangedScenes {
  public:
    /// What the scenes refer to must outlive this object. Throws UsageError for changes of other
    /// kinds than SceneChange says.
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
        // Whether these are the unchanged scene's.
        bool has_same_medium = true, has_same_field = true, has_same_surfaces = true;
        std::vector<char> has_same_emitter;          // for each
        const TexturedSurfaces* textures = nullptr;  // of the surfaces, if they have some
    };

    /// Finds in what `side` is as the unchanged scene.
    void compare(Side& side) const;
    // Whether both sides of a change are the unchanged scene in what light meets on its way, and
    // scatters or reflects it; and in an emitter as well.
    bool keeps_way(std::size_t change) const;
    bool keeps_response(std::size_t change) const;
    bool keeps_emitter(std::size_t change, std::size_t emitter) const;

    const Side& base() const { return sides_.front(); }
    const Side& less(std::size_t change) const { return sides_[1 + 2 * change]; }
    const Side& more(std::size_t change) const { return sides_[2 + 2 * change]; }

    std::vector<Side> sides_;  // of the scene; then less and more of each change
    std::vector<double> steps_;
    std::vector<std::size_t> first_emitters_;  // of each lamp
    std::size_t bands_ = 0, constituents_ = 0;
};

/// By how much the light of paths changes with numbers of a scene, relative to what it is: the
/// score d ln(radiance) / d number, where the path stays where it is. The mean of radiance times
/// score is the derivative of the light, since how often a path is drawn is divided out of its
/// radiance. Of light whose range the number moves (where a shadow ends, or a beam that is cut off)
/// it lacks that part.
///
/// Each factor of a path is differentiated as a central difference, for itself: e^-tau of all that
/// it crosses, the coefficients and phase functions where it is scattered, BRDFs, and intensity,
/// distance and direction of the lamp, which may move. For one path after another, in one thread.
class PathScores {
  public:
    /// `scenes` must outlive it.
    explicit PathScores(const ChangedScenes& scenes) : scenes_(scenes) {}

    /// Forgets all turns.
    void begin() { count_ = 0; }
    /// ContributionSink::turn.
    int add_vertex(int before, const PathVertex& vertex);
    /// Changes `first`, `first + step`, ...: all of them, unless said otherwise.
    struct EveryFew {
        std::size_t first = 0, step = 1;
    };
    /// The scores of a term by these changes, [change * bands + band], in 1 / the number's unit.
    void find(const PathContribution& term, const EveryFew& which, std::span<double> scores);

  private:
    using Side = ChangedScenes::Side;

    // One place on a path. Reused storage.
    struct Corner {
        PathVertex::Kind kind = PathVertex::Kind::camera;
        Point3 position;
        Vector3 in{0, 0, 1};  // in which the path gets there from the camera
        // By side: those of the scene, then of all others whose field or surfaces are others.
        std::vector<double> concentration;
        std::vector<SurfaceHit> hits;
        std::vector<double> scores;  // of the path up to here
    };
    Corner& add_corner();
    // `concentration`: there, if it is not empty.
    void place(Corner& corner, PathVertex::Kind kind, const Point3& position, const SurfaceHit* hit,
               const Corner* before, std::span<const double> concentration = {}) const;
    std::span<const double> concentrations(const Side& side, const Corner& corner) const;
    const SurfaceHit& hit(const Side& side, const Corner& corner) const;
    void add_way(const Point3& from, const Point3& to, std::span<double> scores);
    void add_response(const Corner& corner, const Vector3& out, std::span<double> scores);
    void add_lamp(const PathContribution& term, std::span<double> scores);
    void add_emission(const Corner& corner, std::span<double> scores);
    void add_seen_lamp(std::size_t lamp, std::span<double> scores);
    void eval(const Side& side, const Corner& corner, const Vector3& out, Spectrum& values);
    // Intensity over distance squared times the response at the corner; returns the distance that
    // the light has come.
    double shine(const Side& side, const Corner& corner, std::size_t emitter, Spectrum& values);
    // Adds what the optical depth of light makes that comes from an emitter, after these distances;
    // of a term with columns, of all its way.
    void add_depth(const PathContribution& term, std::size_t change, double radius_less,
                   double radius_more, std::span<double> scores);
    Spectrum emission(const Side& side, const Corner& corner) const;
    void find_column(const Side& side, const Point3& from, const Point3& to,
                     std::vector<double>& column) const;
    // Adds (more - less) / (step times the value) of what `find` finds for a side.
    // Changes that keep it are passed over.
    template <class Keeps, class Find>
    void add_relative(const Keeps& keeps, const Find& find, std::span<double> scores);

    const ChangedScenes& scenes_;
    std::vector<Corner> corners_;
    std::size_t count_ = 0;  // of those in use
    EveryFew which_;         // that are looked for
    Corner last_;
    std::vector<double> column_, base_column_, less_, more_, p_;
};

}  // namespace uw
