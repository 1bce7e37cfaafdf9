#include "render/validation/built_in_suite.h"

#include <cmath>

#include "camera/camera.h"
#include "media/volumes/vdb_writer.h"

namespace uw {

namespace {

constexpr int k_width = 48, k_height = 36;

// A camera at the origin that looks along +z, 60 degrees wide; the world has the camera's axes. A
// wall of reflectance 0.5 ends the view at 4 m.
SceneDesc bare_scene() {
    SceneDesc desc;
    desc.camera.width = k_width;
    desc.camera.height = k_height;
    const double focal = 0.5 * k_width / std::tan(glm::radians(30.0));
    desc.camera.intrinsics = {focal, focal, 0.5 * k_width, 0.5 * k_height};
    GeometryDesc wall;
    wall.type = GeometryDesc::Type::plane;
    wall.point = {0, 0, 4};
    wall.normal = {0, 0, -1};
    desc.geometry = {wall};
    return desc;
}

WaterDesc henyey_greenstein() {
    WaterDesc water;
    water.absorption = PerBand{0.35, 0.08, 0.05};
    water.scattering = ScatteringDesc{{0.20, 0.22, 0.25}, {}};
    water.scattering->phase.function = HenyeyGreensteinDesc{0.9};
    return water;
}

WaterDesc kopelevich() {
    WaterDesc water;
    water.absorption = PerBand{0.30, 0.07, 0.03};
    water.small_ppm = 0.05;
    water.large_ppm = 0.6;
    return water;
}

// Strong, and several pixels wide at the wall.
ForwardScatterDesc forward_scatter(ForwardScatterDesc::Shape shape) {
    ForwardScatterDesc desc;
    desc.K = 1;
    desc.G = 0.02;
    desc.B = 0.1;
    desc.shape = shape;
    return desc;
}

LampDesc lamp(const std::string& name, const Point3& position, double intensity) {
    LampDesc desc;
    desc.name = name;
    desc.position = position;
    desc.intensity = PerBand{intensity, intensity, intensity};
    return desc;
}

GeometryDesc box(const Point3& min, const Point3& max) {
    GeometryDesc desc;
    desc.type = GeometryDesc::Type::box;
    desc.min = min;
    desc.max = max;
    return desc;
}

SceneDesc lamps_around_the_camera() {
    SceneDesc desc = bare_scene();
    desc.water = henyey_greenstein();
    desc.lamps = {lamp("beside", {0.5, -0.3, 0}, 20), lamp("far", {2.5, -1.5, 0.5}, 100),
                  lamp("behind", {0.4, -0.3, -1.5}, 50)};
    return desc;
}

SceneDesc through_a_port() {
    SceneDesc desc = bare_scene();
    desc.water = kopelevich();
    desc.camera.port = FlatPortDesc{};
    std::get<FlatPortDesc>(*desc.camera.port).normal = glm::normalize(Vector3(0.05, -0.03, 1));
    std::get<FlatPortDesc>(*desc.camera.port).distance = 0.02;
    std::get<FlatPortDesc>(*desc.camera.port).thickness = 0.04;
    desc.lamps = {lamp("beside", {1, -0.5, 0}, 50)};
    desc.water.forward_scatter = forward_scatter(ForwardScatterDesc::Shape::exponential);
    return desc;
}

SceneDesc shadow_and_spot() {
    SceneDesc desc = bare_scene();
    desc.water = henyey_greenstein();
    desc.geometry.push_back(box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3}));
    LampDesc spot = lamp("spot", {-1, -0.4, 0}, 80);
    spot.profile = SpotProfileDesc{70, 20};
    spot.direction = glm::normalize(Vector3(0.4, 0.1, 1));
    desc.lamps = {lamp("bare", {1, -0.5, 0}, 50), spot};
    desc.water.forward_scatter = forward_scatter(ForwardScatterDesc::Shape::gaussian);
    return desc;
}

// A Gaussian cloud of sigma 0.25 m, cut at four sigma, in voxels of 4 cm.
SceneDesc plume(const std::filesystem::path& file) {
    constexpr double k_sigma = 0.25, k_voxel = 0.04;
    constexpr int k_reach = 25;
    VdbOutputGrid grid;
    grid.name = "density";
    grid.size = {2 * k_reach + 1, 2 * k_reach + 1, 2 * k_reach + 1};
    grid.voxel_size = k_voxel;
    grid.origin = {-k_reach * k_voxel, -k_reach * k_voxel, 2.2 - k_reach * k_voxel};
    grid.value = [](int i, int j, int k) {
        const Vector3 d = k_voxel * (Vector3(i, j, k) - static_cast<double>(k_reach));
        return static_cast<float>(std::exp(-0.5 * glm::dot(d, d) / (k_sigma * k_sigma)));
    };
    write_vdb(file, {grid}, {{"creator", "uwvdb validate"}});
    SceneDesc desc = shadow_and_spot();
    desc.water = kopelevich();
    desc.water.forward_scatter = forward_scatter(ForwardScatterDesc::Shape::exponential);
    VolumeDesc volume;
    volume.file = file;
    volume.where = "plume";
    volume.centering = Centering::node;
    volume.up = UpAxis::y;
    GridMappingDesc mapping;
    mapping.grid = "density";
    mapping.small_ppm = 0.9;
    mapping.large_ppm = 3;
    mapping.where = "plume";
    volume.grids = {mapping};
    desc.volumes = {volume};
    // The reference integrates exact columns at every sample: fewer pixels.
    desc.camera.width /= 2;
    desc.camera.height /= 2;
    IntrinsicsDesc& k = desc.camera.intrinsics;
    k = {0.5 * k.fx, 0.5 * k.fy, 0.5 * k.cx, 0.5 * k.cy};
    return desc;
}

// All light includes the light that forward scatter approximates.
SceneDesc in_all_light(SceneDesc desc, int width, int height) {
    resize_image(desc.camera, width, height);
    desc.water.forward_scatter = {};
    desc.render.scattering = RenderDesc::Scattering::multiple;
    return desc;
}

}  // namespace

ValidationSuite::ValidationSuite() {
    scenes_ = {{"lamps around the camera", lamps_around_the_camera()},
               {"through a port", through_a_port()},
               {"shadow and spot", shadow_and_spot()},
               {"plume", plume(folder_.path() / "plume.vdb")}};
    // The fast form costs as much in any image that has fewer pixels than it has nodes by default.
    all_light_ = {{"shadow and spot", in_all_light(shadow_and_spot(), 40, 30)}};
    for (auto& [name, desc] : all_light_) desc.file = name;
    for (auto& [name, desc] : scenes_) desc.file = name;
}

}  // namespace uw
