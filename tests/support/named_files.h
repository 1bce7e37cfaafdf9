#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/image/image_file.h"
#include "tests/support/file_bytes.h"
#include "tests/support/meshes/textured_gltf.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/fluid_configs.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {

/// A small scene that names a file in one of the ways in which scenes can.
struct NamedFileCase {
    std::string key;     // of k_file_keys; of what another file names, that file
    std::string file;    // its name
    std::string bytes;   // what it holds
    std::string change;  // "KEY=VALUE" of --set, a line each; @ is the name
    /// Further files of the scene, of which @ is the name as well.
    std::map<std::string, std::string> others{};
    std::string camera = "camera: {resolution: [8, 4], intrinsics: {fov_x: 60}}";
    /// Where the content alone tells of a change: it after one.
    std::string changed{};
    std::vector<std::string> options{};  // without which it is not read
    bool may_be_missing = false;         // the scene is rendered without it

    /// The scene file; `name` stands for the file.
    std::string scene(const std::string& name) const {
        return "uwvdb: 1\n" + with_name(camera, name) +
               "\nwater: {absorption: 0.1, scattering: {b: 0.2, phase: {type: hg, g: 0.8}}}\n"
               "geometry: [{type: plane, point: [0, 0, 4], normal: [0, 0, -1]}]\n"
               "lamps: [{name: left, position: [-0.5, 0, 0], direction: [0, 0, 1], intensity: "
               "50}]\n";
    }
    /// Options of `uwvdb render`.
    std::vector<std::string> arguments(const std::string& name) const {
        std::vector<std::string> sets{"--quality", "draft"};
        std::istringstream changes(with_name(change, name));
        for (std::string one; std::getline(changes, one);) sets.insert(sets.end(), {"--set", one});
        sets.insert(sets.end(), options.begin(), options.end());
        return sets;
    }
    static std::string with_name(std::string text, const std::string& name) {
        for (std::size_t at = 0; (at = text.find('@', at)) != std::string::npos; at += name.size())
            text.replace(at, 1, name);
        return text;
    }
};

/// What a file holds after `write` has written it.
inline std::string bytes_written(const std::string& name,
                                 const std::function<void(const std::filesystem::path&)>& write) {
    const TempDir folder;
    write(folder / name);
    return file_bytes(folder / name);
}

inline std::string exr_bytes(int width, int height) {
    Film film(width, height, {0, 0, width, height}, {"R", "G", "B"});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (float& value : film.pixel(x, y)) value = 0.01F * static_cast<float>(x + y);
    return bytes_written("a.exr", [&](const auto& file) { write_exr(file, film, {}); });
}

/// Every way: those of k_file_keys, and what files of each format name in turn.
inline std::vector<NamedFileCase> named_file_cases() {
    const std::string calibration =
        "cam0:\n  camera_model: pinhole\n  intrinsics: [8, 8, 4, 2]\n"
        "  distortion_model: radtan\n  distortion_coeffs: [0, 0, 0, 0]\n  resolution: [8, 4]\n";
    std::string other_calibration = calibration;
    other_calibration.replace(other_calibration.find("[8, 8"), 5, "[9, 9");
    const std::string poses = "0 0 0 0 0 0 0 1\n9 0.1 0 0 0 0 0 1\n";
    const std::string other_poses = "0 0 0 0 0 0 0 1\n9 0.2 0 0 0 0 0 1\n";
    const std::string colours = "wavelength_nm,r,g,b\n400,0.1,0.2,0.5\n700,0.5,0.2,0.1\n";
    const std::string efficiency = "wavelength_nm,qe\n400,0.5\n700,0.5\n";
    const std::string spectrum = "wavelength_nm,power\n350,1\n800,1\n";
    const std::string phase = "angle_deg,phase\n0,1\n180,1\n";
    const std::string index = "wavelength_nm,n,k\n350,1.14,0.001\n800,1.16,0.003\n";
    const std::string vsf = "angle_deg,beta_540\n1,100\n10,3\n180,0.01\n";
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 3\n1 0 3\n0 1 3\n3 0 1 2\n";
    const std::string ies =
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 50\n0 45 90\n0\n100 50 0\n";
    const std::string sensor_camera =
        "camera: {resolution: [8, 4], intrinsics: {fov_x: 60}, lens: {f_number: 2, focal_length: "
        "0.01}, sensor: {exposure: 0.1, gain: 1, quantum_efficiency: ";
    const std::string silt = "water={particles: {silt: 1}, species: {silt: {size: ";
    const std::string narrow = "{type: junge, diameter: [1 um, 2 um]}, index: ";
    const std::string surface = "water={surface: {point: [0, -5, 0], normal: [0, -1, 0]";
    const std::string volume = "volumes=[{grids: {density: {absorption: 0.1, scattering: 0.1, ";
    const std::string hg = "phase: {type: hg, g: 0}}}, ";
    VdbFixture box;
    box.boxes = {{{0, 0, 0}, {7, 7, 7}, 1.0}};
    const std::string vdb =
        bytes_written("a.vdb", [&](const auto& file) { write_fixture(file, {box}); });
    const std::string moving = bytes_written("a.vdb", [&](const auto& file) {
        write_moving_grid(file, box, {1, 0, 0}, VelocityKind::vectors);
    });
    VdbFixture fluid = box;
    fluid.blender_metadata = true;
    fluid.base_resolution = {19, 19, 19};
    const std::string fluid_vdb =
        bytes_written("a.vdb", [&](const auto& file) { write_fixture(file, {fluid}, ""); });
    const std::string buffer = bytes_of<float>({0, 0, 3, 1, 0, 3, 0, 1, 3});
    const std::string triangle =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
            "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
            "bufferViews":[{"buffer":0,"byteLength":36}],
            "buffers":[{"byteLength":36,"uri":"@"}]})";
    TexturedGltf textured;
    textured.material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
    textured.images = R"([{"uri":"@"}])";
    const std::string obj =
        "v 0 0 3\nv 1 0 3\nv 0 1 3\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\n"
        "f 1/1 2/2 3/3\n";
    const std::string ocio =
        "ocio_profile_version: 1\nroles: {default: lin, scene_linear: lin}\ndisplays:\n  s:\n"
        "    - !<View> {name: V, colorspace: out}\ncolorspaces:\n  - !<ColorSpace> {name: lin}\n"
        "  - !<ColorSpace>\n    name: out\n    from_reference: ";
    const std::vector<std::string> two{"--variations", "2"};

    return {
        {.key = "camera*.calibration",
         .file = "c.yaml",
         .bytes = calibration,
         .change = "",
         .camera = "camera: {calibration: @}",
         .changed = other_calibration},
        {.key = "camera*.calibration.file",
         .file = "c.yaml",
         .bytes = calibration,
         .change = "",
         .camera = "camera: {calibration: {file: @, camera: cam0}}",
         .changed = other_calibration},
        {.key = "camera*.sensor.quantum_efficiency",
         .file = "q.csv",
         .bytes = efficiency,
         .change = "",
         .camera = sensor_camera + "@}}"},
        {.key = "camera*.sensor.quantum_efficiency.file",
         .file = "q.csv",
         .bytes = efficiency,
         .change = "",
         .camera = sensor_camera + "{file: @}}}"},
        {.key = "camera*.sensor.image.response",
         .file = "r.csv",
         .bytes = "input,output\n0,0\n1,1\n",
         .change = "",
         .camera = sensor_camera + "0.5, image: {response: @}}}"},
        {.key = "camera*.trajectory.file",
         .file = "p.tum",
         .bytes = poses,
         .change = "camera.trajectory={file: @}",
         .changed = other_poses},
        {.key = "rig.trajectory.file",
         .file = "p.tum",
         .bytes = poses,
         .change = "",
         .camera = "cameras: [{name: left, resolution: [8, 4], intrinsics: {fov_x: 60}}]\n"
                   "rig: {trajectory: {file: @}}",
         .changed = other_poses},
        {.key = "water.scattering.phase.file",
         .file = "p.csv",
         .bytes = phase,
         .change = "water.scattering.phase={type: table, file: @}"},
        {.key = "water.species.*.size.file",
         .file = "s.csv",
         .bytes = "diameter_um,volume\n1,3\n2,3\n",
         .change = silt + "{type: table, file: @}, index: 1.15}}}"},
        {.key = "water.species.*.coat.index.file",
         .file = "i.csv",
         .bytes = index,
         .change = silt + narrow + "1.15, coat: {thickness: 0.1 um, index: {file: @}}}}}"},
        {.key = "water.species.*.index.file",
         .file = "i.csv",
         .bytes = index,
         .change = silt + narrow + "{file: @}}}}"},
        {.key = "water.species.*.vsf",
         .file = "v.csv",
         .bytes = vsf,
         .change = "water={particles: {mud: 1}, species: {mud: {vsf: @, water: removed}}}"},
        {.key = "water.species.*.absorption.file",
         .file = "a.csv",
         .bytes = "wavelength_nm,absorption\n350,0.3\n800,0.1\n",
         .change = "water={particles: {mud: 1}, species: {mud: {vsf: v.csv, water: removed, "
                   "absorption: {file: @}}}}",
         .others = {{"v.csv", vsf}}},
        {.key = "water.profile",
         .file = "d.csv",
         .bytes = "depth_m,cdom\n0,0.1\n9,0.1\n",
         .change = surface + "}, profile: @}"},
        {.key = "water.surface.waves.file",
         .file = "w.exr",
         .bytes = exr_bytes(8, 8),
         .change = surface + ", n: 1.34, waves: {type: image, file: @, width: 4}}}"},
        {.key = "volumes[*].file",
         .file = "v.vdb",
         .bytes = vdb,
         .change = volume + hg + "file: @}]"},
        {.key = "volumes[*].velocity.file",
         .file = "u.vdb",
         .bytes = moving,
         .change = volume + hg + "file: v.vdb, velocity: {grid: vel, file: @}}]",
         .others = {{"v.vdb", vdb}}},
        {.key = "volumes[*].grids.*.phase.file",
         .file = "p.csv",
         .bytes = phase,
         .change = volume + "phase: {type: table, file: @}}}, file: v.vdb}]",
         .others = {{"v.vdb", vdb}}},
        {.key = "geometry[*].file",
         .file = "m.ply",
         .bytes = ply,
         .change = "geometry=[{file: @}]"},
        {.key = "geometry[*].trajectory.file",
         .file = "p.tum",
         .bytes = poses,
         .change = "geometry=[{type: box, min: [0, 0, 3], max: [1, 1, 4], trajectory: {file: @}}]",
         .changed = other_poses},
        {.key = "lamps[*].profile.file",
         .file = "l.ies",
         .bytes = ies,
         .change = "lamps=[{position: [0, 0, 0], direction: [0, 0, 1], profile: {type: ies, file: "
                   "@}, lumens: 1000, spectrum: {type: blackbody, temperature: 3000}}]"},
        {.key = "lamps[*].spectrum.file",
         .file = "s.csv",
         .bytes = spectrum,
         .change = "lamps=[{position: [0, 0, 0], lumens: 1000, spectrum: {file: @}}]"},
        {.key = "lamps[*].trajectory.file",
         .file = "p.tum",
         .bytes = poses,
         .change = "lamps=[{intensity: 50, trajectory: {file: @}}]",
         .changed = other_poses},
        {.key = "sensors[*].file",
         .file = "imu.yaml",
         .bytes = "update_rate: 200\naccelerometer_noise_density: 0.002\n"
                  "accelerometer_random_walk: 0.003\ngyroscope_noise_density: 0.0002\n"
                  "gyroscope_random_walk: 0.00002\n",
         .change = "sensors=[{type: imu, file: @}]"},
        {.key = "sky.file",
         .file = "sky.exr",
         .bytes = exr_bytes(8, 4),
         .change = surface + ", n: 1.34}}\nsky={model: panorama, file: @}"},
        {.key = "sky.spectrum.file",
         .file = "s.csv",
         .bytes = spectrum,
         .change = surface + ", n: 1.34}}\nsky={model: uniform, lux: 1000, spectrum: {file: @}}"},
        {.key = "render.response",
         .file = "c.csv",
         .bytes = colours,
         .change = "render.response=@"},
        {.key = "render.white.file",
         .file = "w.csv",
         .bytes = spectrum,
         .change = "render={response: cie, white: {file: @}}"},
        {.key = "render.view.config",
         .file = "c.ocio",
         .bytes = ocio + "!<ExponentTransform> {value: [2, 2, 2, 1]}\n",
         .change = "render.view={config: @}"},
        {.key = "variations.*table",
         .file = "t.csv",
         .bytes = "lamps.left.intensity\n50\n60\n",
         .change = "variations={together: [{table: @}]}",
         .changed = "lamps.left.intensity\n51\n61\n",
         .options = two},

        {.key = "buffer of glTF",
         .file = "b.bin",
         .bytes = buffer,
         .change = "geometry=[{file: m.gltf}]",
         .others = {{"m.gltf", triangle}}},
        {.key = "image of glTF",
         .file = "t.png",
         .bytes = four_texel_png(),
         .change = "geometry=[{file: m.gltf}]",
         .others = {{"m.gltf", textured.text()}}},
        {.key = "library of OBJ",
         .file = "a.mtl",
         .bytes = "newmtl a\nKd 0.1 0.2 0.3\n",
         .change = "geometry=[{file: m.obj}]",
         .others = {{"m.obj", "mtllib @\n" + obj}},
         .may_be_missing = true},
        {.key = "image of OBJ",
         .file = "t.png",
         .bytes = four_texel_png(),
         .change = "geometry=[{file: m.obj}]",
         .others = {{"m.obj", "mtllib a.mtl\n" + obj}, {"a.mtl", "newmtl a\nmap_Kd @\n"}},
         .may_be_missing = true},
        {.key = "configuration of a fluid",
         .file = "config/config_0001.uni",
         .bytes = blender_config(),
         .change = volume + hg + "file: data/fluid_data_0001.vdb}]",
         .others = {{"data/fluid_data_0001.vdb", fluid_vdb}},
         .may_be_missing = true},
        {.key = "table of OpenColorIO",
         .file = "t.spi1d",
         .bytes = "Version 1\nFrom 0.0 1.0\nLength 2\nComponents 1\n{\n0.1\n0.7\n}\n",
         .change = "render.view={config: c.ocio}",
         .others = {{"c.ocio", ocio + "!<FileTransform> {src: @, interpolation: linear}\n"}}},
    };
}

}  // namespace uw::test
