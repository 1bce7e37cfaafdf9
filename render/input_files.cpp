#include "render/input_files.h"

#include <variant>

#include "core/meshes/files/mesh_reader.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

/// Walks through a scene description and collects the files that it names.
class InputCollection {
  public:
    explicit InputCollection(MeshSideFiles& known) : known_(known) {}

    void add(const SceneDesc& scene) {
        add(scene.file, "the scene", true);
        add(scene.camera);
        for (const RigCameraDesc& entry : scene.cameras) add(entry.camera);
        add(scene.rig_trajectory);
        if (scene.water.scattering) add(scene.water.scattering->phase);
        for (const VolumeDesc& volume : scene.volumes) add(volume);
        for (const GeometryDesc& geometry : scene.geometry) add(geometry);
        for (const LampDesc& lamp : scene.lamps) {
            add_named(lamp.profile, "a lamp profile of the scene");
            if (lamp.spectrum) add(*lamp.spectrum, "a lamp spectrum of the scene");
            add(lamp.trajectory);
        }
        const ColourDesc& colour = scene.render.colour;
        add(colour.file, "the response of the scene");
        if (colour.white) add(*colour.white, "the white light of the scene");
    }
    std::vector<InputFile> take() && { return std::move(files_); }

  private:
    void add(const fs::path& file, const char* what, bool is_hashed = false) {
        if (!file.empty()) files_.push_back({file, what, is_hashed});
    }
    void add(const CameraDesc& camera) {
        if (camera.calibration) add(camera.calibration->file, "a calibration of the scene", true);
        add(camera.trajectory);
        if (!camera.sensor) return;
        add(camera.sensor->quantum_efficiency.file, "the quantum efficiency of a sensor");
        add(camera.sensor->image.response.file, "the response curve of a camera");
    }
    void add(const std::optional<TrajectoryDesc>& trajectory) {
        if (trajectory) add(trajectory->file, "a trajectory of the scene", true);
    }
    // The file of those alternatives of a variant that have one.
    void add_named(const auto& variant, const char* what) {
        std::visit(
            [&](const auto& desc) {
                if constexpr (requires { desc.file; }) add(desc.file, what);
            },
            variant);
    }
    void add(const PhaseDesc& phase) { add_named(phase.function, "a phase function of the scene"); }
    void add(const LampSpectrumDesc& spectrum, const char* what) {
        if (spectrum.type == LampSpectrumDesc::Type::file) add(spectrum.file, what);
    }
    void add(const VolumeDesc& volume) {
        add(volume.file, "a volume of the scene");
        if (volume.motion) add(volume.motion->file, "a velocity file of the scene");
        for (const GridMappingDesc& grid : volume.grids)
            if (grid.optics && grid.optics->phase) add(*grid.optics->phase);
    }
    void add(const GeometryDesc& geometry) {
        add(geometry.trajectory);
        if (geometry.type != GeometryDesc::Type::file) return;
        add(geometry.file, "a mesh of the scene");
        const auto [found, is_new] = known_.try_emplace(geometry.file);
        if (is_new) found->second = files_named_by_mesh(geometry.file);
        for (const fs::path& file : found->second)
            add(file, "a texture, buffer or material library of a mesh");
    }

    MeshSideFiles& known_;
    std::vector<InputFile> files_;
};

}  // namespace

std::vector<InputFile> input_files(const SceneDesc& scene, MeshSideFiles& known) {
    InputCollection collection(known);
    collection.add(scene);
    return std::move(collection).take();
}

std::vector<InputFile> input_files(const SceneDesc& scene) {
    MeshSideFiles known;
    return input_files(scene, known);
}

}  // namespace uw
