#include "render/derivatives/derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/text.h"
#include "core/geometry/mesh.h"
#include "core/geometry/textured_surfaces.h"
#include "core/light/integrator_table.h"
#include "media/water/water_model.h"
#include "render/derivatives/derivative_images.h"
#include "render/derivatives/path_gradient.h"
#include "render/derivatives/score_gradient.h"
#include "render/derivatives/texel_gradient.h"
#include "render/derivatives/voxel_gradient.h"
#include "render/exposure.h"

namespace uw {

namespace {

// Throws UsageError for images that cannot be differentiated. `name`: of the parameter, for
// messages.
void refuse_other_images(const AssembledScene& scene, const std::string& name) {
    const auto refuse = [&](const char* what) {
        throw UsageError(fmt::format("derivative {}: {}", printable(name), what));
    };
    const LayerPlan plan = layer_plan(scene.image, {});
    if (plan.is_provided(Layer::forward))
        refuse(
            "forward scatter blurs the finished image, and how is not differentiated; remove "
            "water.forward_scatter, or set its K to 0");
    if (plan.is_provided(Layer::snow))
        refuse("marine snow is drawn particle by particle and has none; remove water.snow");
    if (scene.glass) refuse("what glass shows has none; remove the surfaces of glass");
    if (Exposure(scene).part_count() > 0)
        refuse(
            "they are those of a single moment, not of the mean over an exposure; set "
            "render.shutter and camera.line_time to 0");
    if (scene.desc().render.output == RenderDesc::Output::paper)
        refuse("they are those of radiance; remove render.output");
    if (colour_groups_of(scene.desc()).size() > 1)
        refuse(
            "the port refracts each band by itself, and they are those of one ray for all; give "
            "its indices as numbers");
    using enum RenderDesc::Integrator;
    const RenderDesc::Integrator integrator = scene.desc().render.integrator;
    if (integrator != volume && integrator != path)
        refuse("they are computed by the integrators volume and path; choose one of them");
}

void refuse_other_changes(const std::string& name, const SceneDesc& desc,
                          const SceneDesc& changed) {
    const auto refuse = [&](const char* what) {
        throw UsageError(fmt::format("derivative {}: {}", printable(name), what));
    };
    if (name.starts_with("camera.sensor"))
        refuse(
            "light does not depend on the sensor, and its numbers do; give layer=\"sensor\", and "
            "they are differentiated");
    for (const char* const key : {"camera", "cameras", "rig", "render", "frames", "sensors"})
        if (name.starts_with(key))
            refuse(
                "only of the water, volumes, lamps and surfaces; where the camera sees a point has "
                "derivatives by differences of Camera.project");
    if (changed.water.surface != desc.water.surface)
        refuse("the water's surface moves all light; take differences of images");
    if (changed.geometry.size() != desc.geometry.size())
        refuse("it changes what surfaces there are");
    for (std::size_t i = 0; i < desc.geometry.size(); ++i) {
        GeometryDesc other = changed.geometry[i];
        other.reflectance = desc.geometry[i].reflectance;
        if (other != desc.geometry[i])
            refuse("it moves surfaces, and what they hide with them; take differences of images");
    }
}

/// The parts of an assembled scene that scores need, kept while the renderer assembles other
/// scenes.
struct KeptScene {
    explicit KeptScene(const AssembledScene& scene)
        : medium(scene.water.medium),
          emitters(scene.emitters),
          field(scene.field),
          surfaces(scene.surfaces),
          water_surface(scene.water_surface) {}

    LitScene lit() const {
        LitScene lit{&medium, field.get(), surfaces.get(), &emitters};
        lit.water_surface = water_surface ? &*water_surface : nullptr;
        return lit;
    }

    Medium medium;
    std::vector<Lamp> emitters;
    std::shared_ptr<const ConcentrationField> field;
    std::shared_ptr<const Surfaces> surfaces;
    std::optional<WaterSurface> water_surface;
};

/// Whether the scene's light is estimated by random paths.
bool is_by_paths(const AssembledScene& scene) {
    return scene.desc().render.integrator == RenderDesc::Integrator::path ||
           layer_plan(scene.image, {}).is_provided(Layer::multiple);
}

/// Calls `by_paths(pixels, window, draws)` or `by_quadrature(pixels, water, window)` for the
/// renderer's scene, as its light requires, and returns the result.
template <class ByPaths, class ByQuadrature>
auto by_light(Renderer& renderer, const DerivativeOptions& options, const ByPaths& by_paths,
              const ByQuadrature& by_quadrature) {
    const AssembledScene& scene = renderer.assemble();
    const CameraDesc& camera = scene.desc().camera;
    const PixelWindow window =
        options.window.value_or(PixelWindow{0, 0, camera.width, camera.height});
    if (is_by_paths(scene)) {
        const LightTransport transport = make_path_transport(scene, scene.scattering);
        return by_paths(pixel_renderer(scene, transport), window,
                        Draws{samples_of(scene.desc().render), options.seed});
    }
    renderer.splat();
    const LightTransport transport = renderer.make_transport();
    const auto& water = dynamic_cast<const VolumeIntegrator&>(*transport.integrator);
    return by_quadrature(pixel_renderer(scene, transport), water, window);
}

std::vector<float> derivative_images(Renderer& renderer, std::span<const SceneChange> changes,
                                     const DerivativeOptions& options,
                                     const ProgressCallback& progress) {
    const ChangedScenes changed(renderer.assemble().lit(), changes);
    return by_light(
        renderer, options,
        [&](const PixelRenderer& pixels, const PixelWindow& window, const Draws& draws) {
            return path_derivatives(pixels, changed, window, draws, progress);
        },
        [&](const PixelRenderer& pixels, const VolumeIntegrator& water, const PixelWindow& window) {
            return quadrature_derivatives(pixels, water, changed, window, progress);
        });
}

}  // namespace

namespace {

/// Assembles changes of a renderer's scene. The renderer has the same scene afterwards.
class AssembledChanges {
  public:
    AssembledChanges(Renderer& renderer, std::span<const ChangedScene> changes) {
        const ImageScene itself = renderer.scene();
        const auto assembled = [&](const std::string& name, const ImageScene& image) {
            refuse_other_changes(name, itself.desc(), image.desc());
            renderer.set_scene(image);
            kept_.push_back(std::make_unique<const KeptScene>(renderer.assemble()));
            return kept_.back()->lit();
        };
        for (const ChangedScene& change : changes) {
            const LitScene less = assembled(change.name, change.less);
            lit_.push_back({less, assembled(change.name, change.more), change.step});
        }
        renderer.set_scene(itself);
    }

    std::span<const SceneChange> lit() const { return lit_; }

  private:
    std::vector<std::unique_ptr<const KeptScene>> kept_;
    std::vector<SceneChange> lit_;
};

}  // namespace

std::vector<float> scene_derivatives(Renderer& renderer, std::span<const ChangedScene> changes,
                                     const DerivativeOptions& options,
                                     const ProgressCallback& progress) {
    refuse_other_images(renderer.assemble(), changes.empty() ? "" : changes.front().name);
    const AssembledChanges assembled(renderer, changes);
    return derivative_images(renderer, assembled.lit(), options, progress);
}

namespace {

constexpr std::string_view k_concentration = "concentration.";
constexpr std::string_view k_small = "water.particles.small", k_large = "water.particles.large";

/// Returns the fraction of the uniform water's scattering by each phase function, by band.
std::vector<Spectrum> scattering_fractions(const Medium& medium) {
    const Spectrum total = medium.uniform.total_scattering();
    std::vector<Spectrum> fractions = medium.uniform.scattering;
    for (std::size_t b = 0; b < medium.wavelengths_nm.size(); ++b) {
        if (!(total[b] > 0))
            throw UsageError(
                fmt::format("derivative water.scattering: the water does not scatter at {:g} nm, "
                            "so that its phase function is unknown; give it some scattering",
                            medium.wavelengths_nm[b]));
        for (Spectrum& fraction : fractions) fraction[b] /= total[b];
    }
    return fractions;
}

std::size_t constituent_called(const std::string& name, const Medium& medium) {
    const std::string_view wanted = std::string_view(name).substr(k_concentration.size());
    const auto found = std::ranges::find(medium.constituents, wanted, &Constituent::name);
    if (found == medium.constituents.end()) {
        std::string there;
        for (const Constituent& constituent : medium.constituents)
            there += (there.empty() ? "" : ", ") + printable(constituent.name);
        throw UsageError(fmt::format("derivative {}: the volumes hold {}", printable(name),
                                     there.empty() ? "nothing" : there));
    }
    return static_cast<std::size_t>(found - medium.constituents.begin());
}

/// Returns the medium with the parameter `name` increased by one; the coefficients are linear in
/// it.
Medium with_one_more(const std::string& name, const AssembledScene& scene) {
    Medium medium = scene.water.medium;
    const auto bands = static_cast<std::size_t>(medium.band_count());
    if (name.starts_with(k_concentration)) {
        OpticalCoefficients& unit = medium.constituents[constituent_called(name, medium)].per_unit;
        unit.absorption *= 2.0;
        for (Spectrum& b : unit.scattering) b *= 2.0;
    } else if (name == k_small || name == k_large) {
        try {
            return with_one_more_ppm(
                scene.water, scene.desc().water, scene.desc().volumes,
                name == k_small ? WaterParticles::small : WaterParticles::large);
        } catch (const UsageError& fault) {
            throw UsageError(fmt::format("derivative {}: {}", name, fault.what()));
        }
    } else if (name == "water.absorption") {
        for (double& a : medium.uniform.absorption.first(bands)) a += 1;
    } else if (name == "water.scattering") {
        const std::vector<Spectrum> fractions = scattering_fractions(medium);
        for (std::size_t m = 0; m < fractions.size(); ++m)
            medium.uniform.scattering[m] += fractions[m];
    } else {
        throw UsageError(
            fmt::format("derivative '{}': unknown; use water.absorption, water.scattering, "
                        "water.particles.small, water.particles.large or concentration.NAME of a "
                        "constituent",
                        printable(name)));
    }
    return medium;
}

}  // namespace

std::vector<float> named_derivatives(Renderer& renderer, std::span<const std::string> names,
                                     const DerivativeOptions& options,
                                     const ProgressCallback& progress) {
    const AssembledScene& scene = renderer.assemble();
    refuse_other_images(scene, names.empty() ? "" : names.front());
    std::vector<Medium> media;
    media.reserve(names.size());
    std::vector<SceneChange> changes;
    for (const std::string& name : names) {
        media.push_back(with_one_more(name, scene));
        SceneChange change{scene.lit(), scene.lit(), 1.0};
        change.more.medium = &media.back();
        changes.push_back(change);
    }
    return derivative_images(renderer, changes, options, progress);
}

namespace {

// Memory for copies of the gradient, one for each part of an image, of which there are at least two
// [bytes].
constexpr double k_gradient_bytes = 256e6;
constexpr std::size_t k_max_gradient_parts = 16;

const LoadedGrid& array_of(const SceneDesc& desc, std::size_t volume) {
    if (volume >= desc.volumes.size() || desc.volumes[volume].array == nullptr)
        throw UsageError(
            fmt::format("derivative volumes[{}].array: only of the voxels of volumes in memory; "
                        "read the file's grid as an array and add that to the scene",
                        volume));
    return *desc.volumes[volume].array;
}

const Texture& texture_of(const SceneDesc& desc, std::size_t entry) {
    const auto refuse = [&](const char* what) {
        throw UsageError(fmt::format("derivative geometry[{}].texture: {}", entry, what));
    };
    if (entry >= desc.geometry.size() || desc.geometry[entry].mesh == nullptr ||
        !desc.geometry[entry].mesh->materials.front().base_map)
        refuse("only of textures in memory; add the mesh with a texture to the scene");
    if (desc.geometry[entry].reflectance)
        refuse("the scene gives the surface one reflectance in its place; take that out");
    return *desc.geometry[entry].mesh->materials.front().base_map.texture;
}

std::size_t voxel_count(const LoadedGrid& grid) {
    return grid.size[0] * grid.size[1] * grid.size[2];
}

/// The gradients of a request, a copy for each part of the image.
class GradientParts {
  public:
    /// `draws`: if set, only a random selection of each ray's nodes is used.
    GradientParts(const AssembledScene& scene, const GradientRequest& by,
                  std::span<const SceneChange> changes, const std::optional<Draws>& draws)
        : tables_(scene.lit()), changed_(scene.lit(), changes) {
        const SceneDesc& desc = scene.desc();
        double bytes = 0;
        for (const std::size_t volume : by.volumes)
            bytes += 8.0 * static_cast<double>(voxel_count(array_of(desc, volume)));
        for (const std::size_t entry : by.textures) {
            const Texture& texture = texture_of(desc, entry);
            constexpr double k_with_halves = 4.0 / 3;
            bytes += 8.0 * 3 * k_with_halves * texture.width() * texture.height();
        }
        const auto parts = static_cast<std::size_t>(
            std::clamp(k_gradient_bytes / std::max(bytes, 1.0), 2.0, double{k_max_gradient_parts}));
        require_memory(bytes * static_cast<double>(parts),
                       "the derivatives by voxel and texel need", "use fewer of them");
        for (std::size_t part = 0; part < parts; ++part) {
            std::optional<std::uint64_t> seed;
            if (draws) seed = PathRandom::seed_of(part, static_cast<std::uint64_t>(draws->seed));
            add_part(scene, by, seed);
        }
    }

    std::span<const PartGradients> parts() const { return parts_; }

    SceneGradient sums() const {
        SceneGradient result;
        for (const ScoreGradient* part : by_change_) {
            result.by_change.resize(part->by_change().size());
            for (std::size_t i = 0; i < part->by_change().size(); ++i)
                result.by_change[i] += part->by_change()[i];
        }
        for (const auto& of_parts : by_voxel_)
            result.by_voxel.push_back(
                sum(of_parts, [](const VoxelGradient& part) { return part.values(); }));
        for (const auto& of_parts : by_texel_)
            result.by_texel.push_back(
                sum(of_parts, [](const TexelGradient& part) { return part.by_texel(); }));
        return result;
    }

  private:
    void add_part(const AssembledScene& scene, const GradientRequest& by,
                  std::optional<std::uint64_t> seed) {
        PartGradients& gradients = parts_.emplace_back();
        const auto add = [&](auto gradient) {
            const auto* const added = gradient.get();
            gradients.push_back(std::move(gradient));
            return added;
        };
        if (!by.changes.empty())
            by_change_.push_back(add(std::make_unique<ScoreGradient>(changed_, seed)));
        by_voxel_.resize(by.volumes.size());
        for (std::size_t i = 0; i < by.volumes.size(); ++i) {
            const std::size_t volume = by.volumes[i];
            voxels_.push_back(std::make_unique<VoxelGradient>(scene.volumes[volume].grids.front(),
                                                              array_of(scene.desc(), volume).size));
            by_voxel_[i].push_back(voxels_.back().get());
            add(std::make_unique<PathGradient>(tables_, *voxels_.back()));
        }
        by_texel_.resize(by.textures.size());
        for (std::size_t i = 0; i < by.textures.size(); ++i)
            by_texel_[i].push_back(add(std::make_unique<TexelGradient>(
                *textures_of(*scene.surfaces), texture_of(scene.desc(), by.textures[i]),
                changed_.bands())));
    }

    template <class Gradient, class Values>
    static std::vector<float> sum(const std::vector<const Gradient*>& parts, const Values& values) {
        std::vector<double> total;
        for (const Gradient* part : parts) {
            const auto& of_part = values(*part);
            total.resize(of_part.size());
            for (std::size_t i = 0; i < of_part.size(); ++i) total[i] += of_part[i];
        }
        return {total.begin(), total.end()};
    }

    GradientTables tables_;
    ChangedScenes changed_;
    std::vector<PartGradients> parts_;
    std::vector<std::unique_ptr<VoxelGradient>> voxels_;
    std::vector<const ScoreGradient*> by_change_;              // of each part
    std::vector<std::vector<const VoxelGradient*>> by_voxel_;  // of each volume, of each part
    std::vector<std::vector<const TexelGradient*>> by_texel_;  // of each texture
};

}  // namespace

SceneGradient scene_gradient(Renderer& renderer, const GradientRequest& by,
                             std::span<const double> weights, const DerivativeOptions& options,
                             const ProgressCallback& progress) {
    refuse_other_images(renderer.assemble(),
                        by.changes.empty() ? "by voxel or texel" : by.changes.front().name);
    const AssembledChanges changes(renderer, by.changes);
    const AssembledScene& scene = renderer.assemble();
    std::optional<Draws> draws;
    if (scene.desc().render.quality != RenderDesc::Quality::exact && !is_by_paths(scene))
        draws = {.seed = options.seed};
    const GradientParts gradients(scene, by, changes.lit(), draws);
    const auto weights_of = [&](const PixelWindow& window) {
        return PixelWeights{window, scene.desc().water.bands_nm.size(), weights};
    };
    by_light(
        renderer, options,
        [&](const PixelRenderer& pixels, const PixelWindow& window, const Draws& paths) {
            path_gradient(pixels, weights_of(window), paths, gradients.parts(), progress);
        },
        [&](const PixelRenderer& pixels, const VolumeIntegrator& water, const PixelWindow& window) {
            quadrature_gradient(pixels, water, weights_of(window), draws, gradients.parts(),
                                progress);
        });
    return gradients.sums();
}

}  // namespace uw
