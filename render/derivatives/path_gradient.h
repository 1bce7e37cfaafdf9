#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/light/integrator.h"
#include "core/light/medium.h"
#include "render/derivatives/contribution_gradient.h"

namespace uw {

/// The tables of a scene that PathGradient looks up. Thread safe.
struct GradientTables {
    explicit GradientTables(const LitScene& of)
        : scene(of), attenuation(*of.medium), phases(*of.medium) {}

    LitScene scene;
    AttenuationTable attenuation;
    PhaseTable phases;
};

/// The derivative of a scalar by the values of a field, given its derivatives by the contributions
/// of light paths: the transpose (back-propagation) of PathScores. Sensitivities are propagated
/// back along the paths, once for all contributions that share a segment, and to each point where
/// the field scatters. Not thread safe.
class PathGradient final : public ContributionGradient {
  public:
    /// What is referred to must outlive this object.
    PathGradient(const GradientTables& tables, FieldGradient& gradient)
        : tables_(tables),
          gradient_(gradient),
          bands_(static_cast<std::size_t>(tables.scene.medium->band_count())),
          constituents_(tables.scene.medium->constituents.size()) {}

    int add_vertex(int before, const PathVertex& vertex) override;
    void add(const PathContribution& contribution, std::span<const double> sensitivity) override;
    void finish() override;

  private:
    struct Vertex {
        PathVertex::Kind kind = PathVertex::Kind::camera;
        int before = k_no_vertex;
        Point3 position;
        Vector3 in{0, 0, 1};
        std::vector<double> sensitivity;  // by band, of all contributions through this vertex
    };
    // The end of a segment on the camera ray, and the sensitivities of the columns up to it, by
    // constituent.
    struct ColumnWeights {
        double distance = 0;
        std::vector<double> weights;
    };

    // Adds the derivative by the transmittance from `from` to `to`, and by the scattering at
    // `from`.
    void add_transmittance(const Vertex& from, const Point3& to, const Vector3& direction,
                           std::span<const double> sensitivity);
    // Adds the derivative by the scattering coefficients at `x`, where the path, followed from the
    // camera, is scattered from the direction `in` to `out`.
    void add_scattering(const Point3& x, const Vector3& in, const Vector3& out,
                        std::span<const double> sensitivity);
    void find_column_weights(std::span<const double> sensitivity);

    const GradientTables& tables_;
    FieldGradient& gradient_;
    std::size_t bands_, constituents_;
    std::vector<Vertex> vertices_;
    std::size_t count_ = 0;
    std::vector<ColumnWeights> camera_columns_;
    std::size_t camera_column_count_ = 0;
    std::vector<double> weights_, concentration_, p_, per_unit_;
};

}  // namespace uw
