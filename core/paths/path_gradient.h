#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/light/integrator.h"
#include "core/light/medium.h"
#include "core/paths/contribution_gradient.h"

namespace uw {

/// What lengths, columns and phase functions of a scene are worth to its light: looked up by
/// PathGradient. Thread safe.
struct GradientTables {
    explicit GradientTables(const LitScene& of)
        : scene(of), attenuation(*of.medium), phases(*of.medium) {}

    LitScene scene;
    AttenuationTable attenuation;
    PhaseTable phases;
};

/// The derivative of a number by the values of a field, from that by the light of paths: the
/// transpose of PathScores. What terms are worth is handed back along their ways, once for all that
/// share a stretch of it, and to each place where the field scatters them. For one thread.
class PathGradient final : public ContributionGradient {
  public:
    /// What is referred to must outlive it.
    PathGradient(const GradientTables& tables, FieldGradient& gradient)
        : tables_(tables),
          gradient_(gradient),
          bands_(static_cast<std::size_t>(tables.scene.medium->band_count())),
          constituents_(tables.scene.medium->constituents.size()) {}

    int add_vertex(int before, const PathVertex& vertex) override;
    void add(const PathContribution& term, std::span<const double> worth) override;
    void finish() override;

  private:
    struct Corner {
        PathVertex::Kind kind = PathVertex::Kind::camera;
        int before = k_no_vertex;
        Point3 position;
        Vector3 in{0, 0, 1};
        std::vector<double> worth;  // by band, of all terms by way of here
    };
    // A place on the camera's ray, and what columns up to there are worth, by constituent.
    struct Reach {
        double distance = 0;
        std::vector<double> weights;
    };

    // Light of this worth passes from `from`, where it may be scattered, to `to`.
    void add_way(const Corner& from, const Point3& to, const Vector3& direction,
                 std::span<const double> worth);
    // It is scattered at a place where it arrives along `in` and leaves along `out`.
    void add_scattering(const Point3& x, const Vector3& in, const Vector3& out,
                        std::span<const double> worth);
    void find_column_weights(std::span<const double> worth);

    const GradientTables& tables_;
    FieldGradient& gradient_;
    std::size_t bands_, constituents_;
    std::vector<Corner> corners_;
    std::size_t count_ = 0;
    std::vector<Reach> reaches_;
    std::size_t reach_count_ = 0;
    std::vector<double> weights_, concentration_, p_, per_unit_;
};

}  // namespace uw
