#include "render/light_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/surface_reflection.h"
#include "core/light/integrator_table.h"
#include "core/light/lamp_factory.h"
#include "core/light/ray_panels.h"
#include "core/light/sky_emitter.h"
#include "core/light/surface_lighting.h"
#include "core/paths/path_segment.h"

namespace uw {

namespace {

constexpr std::size_t k_times_as_many = 4;  // factor on the number of points, for comparison
constexpr std::size_t k_max_points = 1024;  // the maximum of `samples`
constexpr int k_rays_across = 12, k_rays_down = 9;  // rays over the image
constexpr int k_places = 6;  // on each ray, at equal steps of 1 - transmittance

bool is_pointed(const LampDesc& lamp) {
    return lamp.sky || lamp.emissive_volume;
}

std::size_t count_of(const AssembledScene& scene, std::size_t lamp) {
    return static_cast<std::size_t>(std::ranges::count_if(scene.emitters, [&](const Lamp& each) {
        return each.index() == lamp && !each.is_mirrored();
    }));
}

bool is_met_by_paths(const AssembledScene& scene, std::size_t lamp) {
    const auto emitter = std::ranges::find(scene.emitters, lamp, &Lamp::index);
    return emitter != scene.emitters.end() && emitter->is_met_by_paths();
}

/// Returns the emitters of the pointed lamps, `times` as many of each.
std::vector<Lamp> pointed_emitters(const AssembledScene& scene, std::size_t times) {
    std::vector<Lamp> emitters;
    auto emissive = scene.emissions.begin();
    for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
        const LampDesc& desc = scene.desc().lamps[i];
        if (!is_pointed(desc)) continue;
        const auto count = static_cast<int>(std::min(times * count_of(scene, i), k_max_points));
        const std::size_t first = emitters.size();
        if (desc.sky) {
            SkyDesc sky = *desc.sky;
            sky.samples = count;
            LampDesc finer = desc;
            finer.sky = std::make_shared<const SkyDesc>(std::move(sky));
            append_emitters(finer, scene.lamps[i], i, 1, *scene.sky, emitters);
            continue;
        }
        const EmissiveVolume& volume = *(emissive++)->volume;
        append_emitters(scene.lamps[i], i, divide_emission(*volume.field, volume.emission, count),
                        emitters);
        if (is_met_by_paths(scene, i))
            for (Lamp& emitter : std::span(emitters).subspan(first))
                emitter = emitter.met_by_paths();
        if (scene.water_surface) append_mirror_images(*scene.water_surface, first, emitters);
    }
    return emitters;
}

/// Computes the light of emitters along rays, by lamp: direct light on surfaces, and single
/// scattering by a quadrature with a few nodes.
class PointLight {
  public:
    PointLight(const AssembledScene& scene, std::vector<Lamp> emitters)
        : emitters_(std::move(emitters)),
          scene_(with_emitters(scene.lit(), emitters_)),
          lamps_(scene.lamps.size()),
          optics_(scene_, true),
          phases_(*scene_.medium),
          sky_(scene_),
          surfaces_(scene_) {}

    /// Returns the radiance at the ray's origin by lamp, as mean over the bands.
    std::vector<double> along(const Ray& ray) const {
        std::vector<double> light(lamps_, 0.0);
        WaterSegment segment;
        optics_.trace(ray, segment);
        WaterPoint point;
        optics_.look_up(segment, segment.length, point);
        Spectrum left{};
        if (segment.has_hit) {
            optics_.transmittances(segment.length, point.column, left);
            if (!segment.hit.is_water_surface) add_surface(segment, light);
        }
        const std::vector<OfSky> sky = find_sky(ray.direction);
        for (std::size_t b = 0; b < optics_.bands(); ++b)
            add_water(segment, b, left[b], sky, light);
        return light;
    }

  private:
    // What SkyScattering finds.
    struct OfSky {
        std::vector<double> phase;
        double lengthening = 1;
    };

    // By emitter.
    std::vector<OfSky> find_sky(const Vector3& direction) const {
        std::vector<OfSky> sky(emitters_.size());
        SkyScattering::Workspace workspace;
        for (std::size_t j = 0; j < sky.size(); ++j)
            if (sky_.contains(j))
                sky[j].lengthening = sky_.find(j, direction, sky[j].phase, workspace);
        return sky;
    }

    static LitScene with_emitters(LitScene scene, const std::vector<Lamp>& emitters) {
        scene.emitters = &emitters;
        return scene;
    }

    void add_surface(const WaterSegment& segment, std::vector<double>& light) const {
        const SurfaceSample sample{segment.ray, segment.hit, 0, 0};
        SurfaceLight arriving;
        surfaces_.evaluate_one(sample, arriving);
        const auto bands = static_cast<int>(optics_.bands());
        const SurfaceReflection reflection(*scene_.surfaces, sample, bands);
        Spectrum brdf;
        for (std::size_t j = 0; j < emitters_.size(); ++j) {
            if (!arriving.visible(0, j)) continue;
            brdf_for(emitters_[j], reflection, sample, brdf);
            for (std::size_t b = 0; b < optics_.bands(); ++b)
                light[emitters_[j].index()] +=
                    arriving.irradiance(0, j, b) * brdf[b] * arriving.to_camera(0)[b] / bands;
        }
    }

    // `left` is the transmittance of the whole segment in this band.
    void add_water(const WaterSegment& segment, std::size_t band, double left,
                   std::span<const OfSky> sky, std::vector<double>& light) const {
        WaterPoint point;
        std::vector<double> c(optics_.bands()), column(optics_.constituents());
        std::vector<double> p(scene_.medium->phase_functions.size());
        for (int k = 0; k < k_places; ++k) {
            const double fraction = (k + 0.5) / k_places * (1 - left);
            const double s = optics_.distance_at_depth(segment, band, -std::log1p(-fraction));
            if (!(s < segment.length)) continue;
            optics_.look_up(segment, s, point);
            optics_.find_scattering(point);
            optics_.attenuations(point, c);
            if (!(c[band] > 0)) continue;
            // The nodes have the pdf c e^-tau / (1 - left).
            const double weight =
                (1 - left) / (k_places * c[band] * static_cast<double>(optics_.bands()));
            const Point3 x = segment.ray.at(s);
            for (std::size_t j = 0; j < emitters_.size(); ++j) {
                const Lamp& lamp = emitters_[j];
                if (lamp.is_met_by_paths()) continue;
                const LampPassage passage = lamp.passage(segment.ray);
                double radius = passage.radius(s);
                if (!(radius > 0) || lamp.contains(radius)) continue;
                const Point3 origin = lamp.origin(x);
                const double relative = lamp.relative_intensity(x - origin);
                if (!(relative > 0) || scene_.surfaces->occluded(origin, x)) continue;
                scene_.field->column(origin, x, column);
                if (sky_.contains(j)) {
                    p = sky[j].phase;
                    radius *= sky[j].lengthening;
                    for (double& value : column) value *= sky[j].lengthening;
                } else {
                    const double h = passage.half_tangent(s, radius);
                    phases_.eval(std::span(&h, 1), p);
                }
                double beta = 0;
                for (std::size_t m = 0; m < p.size(); ++m) beta += point.scattering[m][band] * p[m];
                const double tau = optics_.attenuation().optical_depth(band, radius, column);
                light[lamp.index()] += weight * beta * relative * lamp.axis_intensity()[band] *
                                       std::exp(-tau) / lamp.spread(radius);
            }
        }
    }

    std::vector<Lamp> emitters_;
    LitScene scene_;
    std::size_t lamps_;
    WaterOptics optics_;
    PhaseTable phases_;
    SkyScattering sky_;
    DirectLighting surfaces_;
};

}  // namespace

std::vector<PointedLamp> find_pointed_lamps(const AssembledScene& scene) {
    std::vector<PointedLamp> lamps;
    for (std::size_t i = 0; i < scene.lamps.size(); ++i)
        if (is_pointed(scene.desc().lamps[i]) && count_of(scene, i) < k_max_points)
            lamps.push_back({i, count_of(scene, i), 0});
    if (lamps.empty()) return lamps;
    const PointLight all(scene, scene.emitters), few(scene, pointed_emitters(scene, 1)),
        many(scene, pointed_emitters(scene, k_times_as_many));
    const LampsInView in_view(scene.lit());
    const AttenuationTable attenuation(scene.water.medium);
    struct OfRay {
        double all = 0;
        std::vector<double> few, many;
    };
    std::vector<OfRay> rays(static_cast<std::size_t>(k_rays_across * k_rays_down));
    const auto bands = static_cast<std::size_t>(scene.water.medium.band_count());
    parallel_for(rays.size(), [&](std::size_t n) {
        throw_if_stopped();
        const double across = (static_cast<double>(n % k_rays_across) + 0.5) / k_rays_across;
        const double down = (static_cast<double>(n / k_rays_across) + 0.5) / k_rays_down;
        const auto ray = scene.camera->refracted_ray(across * scene.camera->width(),
                                                     down * scene.camera->height());
        if (!ray) return;
        OfRay& light = rays[n];
        for (const double of_lamp : all.along(*ray)) light.all += of_lamp;
        light.few = few.along(*ray);
        light.many = many.along(*ray);
        // The lamps that the camera sees directly are exact.
        SurfaceHit hit;
        const bool has_hit = scene.surfaces->closest_hit(*ray, k_far, hit);
        std::vector<SeenLamp> visible_lamps;
        in_view.append(*ray, has_hit ? hit.distance : k_far, visible_lamps);
        Spectrum direct{};
        for (const SeenLamp& lamp : visible_lamps) direct += lamp.arriving;
        if (has_hit && hit.has_material) {
            std::vector<double> column(attenuation.constituents.size());
            scene.field->column(ray->origin, hit.position, column);
            direct += attenuation.transmittance(hit.distance, column) *
                      scene.surfaces->material(hit).emission;
        }
        for (const double band : direct.first(bands))
            light.all += band / static_cast<double>(bands);
    });
    double mean = 0;
    for (const OfRay& ray : rays) mean += ray.all / static_cast<double>(rays.size());
    if (!(mean > 0)) return {};
    for (PointedLamp& lamp : lamps) {
        double squares = 0;
        for (const OfRay& ray : rays)
            if (!ray.few.empty()) {
                const double change = ray.many[lamp.lamp] - ray.few[lamp.lamp];
                squares += change * change;
            }
        lamp.change = std::sqrt(squares / static_cast<double>(rays.size())) / mean;
    }
    return lamps;
}

std::vector<std::string> pointed_lamp_notes(const AssembledScene& scene,
                                            const std::vector<PointedLamp>& lamps) {
    std::vector<std::string> notes;
    for (const PointedLamp& lamp : lamps) {
        if (!lamp.matters()) continue;
        const LampDesc& desc = scene.desc().lamps[lamp.lamp];
        const bool is_sky = desc.sky != nullptr;
        const std::size_t more = std::min(k_times_as_many * lamp.count, k_max_points);
        // The scene's number of samples, of which drafts use a part.
        const auto samples = static_cast<std::size_t>(
            is_sky ? desc.sky->samples : desc.emissive_volume->emission.samples);
        const bool is_single = scattering_of(scene.desc().render) == RenderDesc::Scattering::single;
        notes.push_back(fmt::format(
            "the {} lights this scene as {} {}: with {} of them the image changes by about {:.0f} "
            "% (RMS), which no stated error includes; {}: {} renders that{}",
            is_sky ? "sky" : "volume '" + desc.name + "'", lamp.count, is_sky ? "parts" : "points",
            more, 100 * lamp.change, is_sky ? "sky.samples" : "its emission's samples",
            std::min(k_times_as_many * samples, k_max_points),
            !is_sky && is_single ? ", and in the water render.scattering: multiple needs none"
                                 : ""));
    }
    return notes;
}

}  // namespace uw
