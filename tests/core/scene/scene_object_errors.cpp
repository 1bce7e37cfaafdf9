// ctest labels: unit
#include "tests/support/scene_errors.h"

namespace uw {
namespace {

using test::k_base;
using SceneObjectErrors = test::SceneErrors;

TEST_F(SceneObjectErrors, volumes) {
    check(std::string(k_base) + "volumes:\n",
          {
              {"  file: a.vdb\n",
               "scene.yaml:4:3: volumes: expected a list, found a map; write one '- "
               "file: ...' per volume"},
              {"- {grids: {d: {small: 1}}}\n", "scene.yaml:4:3: volumes[0]: 'file' is missing"},
              {"- {file: a.vdb}\n", "volumes[0]: 'grids' is missing; write {density:"},
              {"- {file: b.vdb}\n",
               "scene.yaml:4:10: volumes[0].file: no such file 'b.vdb' (looked in "},
              {"- {file: 'b_%4d.vdb'}\n", "volumes[0].file: no such file 'b_%4d.vdb'"},
              {"- {file: sub}\n", "volumes[0].file: 'sub' is a folder; name a file in it"},
              {"- {file: ''}\n", "volumes[0].file: is empty; give the name of a file"},
              {"- {file: [a.vdb]}\n", "volumes[0].file: expected text, found a list of 1"},
              {"- {file: a.vdb, grids: density}\n",
               "volumes[0].grids: expected grid names with their "
               "meanings, found the text 'density'"},
              {"- {file: a.vdb, grids: {}}\n", "volumes[0].grids: expected grid names"},
              {"- {file: a.vdb, grids: {d: 5}}\n",
               "volumes[0].grids.d: expected a map, found the number "
               "5; write {small: 2, large: 10} in ppm"},
              {"- {file: a.vdb, grids: {d: {}}}\n",
               "volumes[0].grids.d: does not say what the grid means"},
              {"- {file: a.vdb, grids: {d: {small: 1, phase: {type: water}}}}\n",
               "volumes[0].grids.d.phase: is not used by a grid given in ppm; remove it"},
              {"- {file: a.vdb, grids: {d: {small: 1, scattering: 1}}}\n",
               "volumes[0].grids.d.small: is not used by a grid with 'absorption' or 'scattering'"},
              {"- {file: a.vdb, grids: {d: {large: -1}}}\n",
               "volumes[0].grids.d.large: must not be neg"},
              {"- {file: a.vdb, grids: {d: {scattering: [1, 2, 3, 4]}}}\n",
               "volumes[0].grids.d.scattering: has 4 values, but water.bands has 3"},
              {"- {file: a.vdb, grids: {d: {small: 1}}, centering: cel}\n",
               "volumes[0].centering: unknown value 'cel'; did you mean 'cell'?"},
              {"- {file: a.vdb, grids: {d: {small: 1}}, up: w}\n",
               "scene.yaml:4:45: volumes[0].up: unknown value 'w'; use one of: x, y, z"},
              {"- {file: a.vdb, grids: {d: {small: 1}}, transform: {scale: [1, 0, 1]}}\n",
               "volumes[0].transform.scale: must not be 0"},
              {"- {file: a.vdb, grids: {d: {small: 1}}, transform: {rotate: 90}}\n",
               "volumes[0].transform.rotate: expected a list of 3, found the number 90"},
          });
}

TEST_F(SceneObjectErrors, geometry) {
    check(
        std::string(k_base) + "geometry:\n",
        {
            {"- {}\n",
             "scene.yaml:4:3: geometry[0]: 'file' is missing; give a mesh file, or type:"},
            {"- {type: cube}\n", "scene.yaml:4:10: geometry[0].type: unknown value 'cube'; "},
            {"- {type: box, min: [0, 0, 0], max: [1, 1, 0]}\n",
             "scene.yaml:4:36: geometry[0].max: max must be greater than min on every axis, found "
             "0 "
             "against 0 on z"},
            {"- {type: box, min: [0, 0, 0]}\n", "geometry[0]: 'max' is missing"},
            {"- {type: box, min: [0, 0, 0], max: [1, 1, 1], radius: 1}\n",
             "scene.yaml:4:47: geometry[0].radius: is not used by type 'box'; remove it"},
            {"- {type: sphere, center: [0, 0], radius: 1}\n",
             "geometry[0].center: expected a list of "
             "3, found a list of 2"},
            {"- {type: sphere, center: [0, 0, 0], radius: 0}\n",
             "geometry[0].radius: must be greater"},
            {"- {type: sphere, center: [0, 0, 0], radius: 2m}\n",
             "geometry[0].radius: expected a number, found '2m'; write the number alone, without a "
             "unit (give the sphere's radius in metres)"},
            {"- {type: sphere, center: [0, 0, 0], radius: 1, transform: {scale: 2}}\n",
             "geometry[0].transform: is not used by type 'sphere'; remove it"},
            {"- {type: plane, point: [0, 0, 0], normal: [0, 0, 0]}\n",
             "geometry[0].normal: [0, 0, 0]"},
            {"- {file: a.vdb, reflectance: 50}\n",
             "geometry[0].reflectance: must be from 0 to 1, "
             "found 50, which looks like percent"},
            {"- {file: a.vdb, reflectance: [0.5, 0.5, 200]}\n",
             "geometry[0].reflectance[2]: must be from 0 to 1, found 200, which looks like an "
             "8-bit"},
            {"- {file: a.vdb, type: plane, point: [0, 0, 0], normal: [0, 1, 0]}\n",
             "geometry[0].file: is not used by type 'plane'; remove it"},
        });
}

TEST_F(SceneObjectErrors, lamps) {
    const std::string start = "- {name: a, position: [0, 0, 0], ";
    check(std::string(k_base) + "lamps:\n",
          {
              {start + "intensty: 5}\n",
               "scene.yaml:4:34: lamps[0].intensty: unknown key; did you mean "
               "'intensity'?"},
              {start + "}\n",
               "scene.yaml:4:3: lamps[0]: does not say how bright it is; give intensity in"},
              {start + "intensity: 5, power: 3}\n",
               "lamps[0].power: a lamp has either intensity or "},
              {start + "intensity: [5, -5, 5]}\n", "lamps[0].intensity[1]: must not be negative"},
              {start + "power: [5, 5]}\n", "lamps[0].power: has 2 values, but water.bands has 3"},
              {start + "intensity: 1, direction: [0, 0, 0]}\n",
               "lamps[0].direction: [0, 0, 0] has no"},
              {start + "intensity: 1, frame: wrld}\n",
               "lamps[0].frame: unknown value 'wrld'; did you"},
              {start + "intensity: 1, profile: {type: ies, file: a.ies}}\n",
               "lamps[0].profile.file: no such file 'a.ies'"},
              {start + "profile: {type: ies, file: a.vdb, tilt: 200}}\n",
               "lamps[0].profile.tilt: must be from -180 to 180, found 200"},
              {start + "intensity: 1, profile: {type: isotropic, rotate: 5}}\n",
               "lamps[0].profile.rotate: is not used by profile type 'isotropic'; remove it"},
              {start + "intensity: 1, profile: {type: spt}}\n",
               "unknown value 'spt'; did you mean 'spot"},
              {start + "intensity: 1, profile: {type: spot}}\n",
               "lamps[0].profile: 'beam' is missing"},
              {start + "intensity: 1, profile: {type: spot, beam: 181}}\n",
               "lamps[0].profile.beam: must be greater than 0 and at most 180, found 181"},
              {start + "intensity: 1, profile: {type: spot, beam: 10, edge: 20}}\n",
               "lamps[0].profile.edge: must not be wider than the beam of 10, found 20"},
              {start + "intensity: 1, profile: {type: spot, beam: 10, fwhm: 20}}\n",
               "lamps[0].profile.fwhm: is not used by profile type 'spot'; remove it"},
              {start + "intensity: 1, profile: {type: cosine, fwhm: 180}}\n",
               "lamps[0].profile.fwhm: must lie between 0 and 180, found 180"},
              {"- {name: 'a b', position: [0, 0, 0], intensity: 1}\n",
               "scene.yaml:4:10: lamps[0].name: 'a b' cannot be part of a layer's name; use only "
               "letters"},
              {"- {name: a, intensity: 1}\n", "lamps[0]: 'position' is missing"},
              {start + "intensity: 1}\n" + start + "intensity: 1}\n",
               "scene.yaml:5:3: lamps[1]: the name 'a' is taken by another lamp"},
          });
}

TEST_F(SceneObjectErrors, spectraOfLamps) {
    const std::string start = "- {name: a, position: [0, 0, 0], ";
    check(
        std::string(k_base) + "lamps:\n",
        {
            {start + "spectrum: {type: led, name: LED-B4}}\n",
             "lamps[0]: does not say how bright it is; give intensity in W/sr or power in W, or "
             "its spectrum and lumens"},
            {start + "lumens: 100}\n",
             "lamps[0].lumens: only the lamp's spectrum can convert lumens to watts; give it"},
            {start + "spectrum: {type: flat}, lumens: 0}\n", "lamps[0].lumens: must be greater"},
            {start + "spectrum: {type: flat}, lumens: 1, power: 3}\n",
             "lamps[0].lumens: a lamp has either lumens or watts; remove one"},
            {start + "spectrum: {type: flat}, power: [1, 2, 3]}\n",
             "lamps[0].power: expected a number, found a list"},
            {start + "spectrum: {type: led}, power: 1}\n", "lamps[0].spectrum: 'name' is missing"},
            {start + "spectrum: {type: blackbody}, power: 1}\n",
             "lamps[0].spectrum: 'temperature' is missing"},
            {start + "spectrum: {type: blackbody, temperature: 5}, power: 1}\n",
             "lamps[0].spectrum.temperature: must be from 500 to 100000, found 5"},
            {start + "spectrum: {type: d65, name: x}, power: 1}\n",
             "lamps[0].spectrum.name: is not used by spectrum type 'd65'; remove it"},
            {start + "spectrum: {file: b.csv}, power: 1}\n",
             "lamps[0].spectrum.file: no such file 'b.csv'"},
            {start + "spectrum: {file: sub/a.csv, name: x}, power: 1}\n",
             "lamps[0].spectrum.name: is not used by a spectrum with 'file'; remove it"},
            {start + "spectrum: {}, power: 1}\n", "lamps[0].spectrum: 'type' is missing"},
        });
}

TEST_F(SceneObjectErrors, render) {
    check(std::string(k_base) + "render:\n",
          {
              {"  integrator: paths\n", "render.integrator: unknown value 'paths'; "},
              {"  scattering: double\n",
               "render.scattering: unknown value 'double'; use one of: single, multiple"},
              {"  output: irradiance\n", "render.output: unknown value 'irradiance'; "},
              {"  output: paper\n",
               "scene.yaml:4:11: render.output: needs the camera's lens; give camera.lens: {"},
              {"  output: sensor_irradiance\n", "render.output: needs the camera's lens; give "},
              {"  samples: 0\n", "render.samples: must be from 1 to 4096, found 0"},
              {"  samples: 4097\n", "render.samples: must be from 1 to 4096, found 4097"},
              {"  integrator: path\n  samples: 65537\n",
               "render.samples: must be from 1 to 65536, found 65537"},
              {"  samples: 2.5\n", "render.samples: expected a whole number, found 2.5"},
              {"  planes: {count: 3, near: 2, far: 1}\n",
               "render.planes.far: must be greater than near"},
              {"  planes: {near: -1}\n", "render.planes.near: "},
              {"  planes: {count: 0}\n", "render.planes.count: must be from 1 to 65536"},
              {"  planes: {far: 0}\n", "render.planes.far: "},
              {"  seed: 3\n", "scene.yaml:4:3: render.seed: unknown key; "},
          });
}

TEST_F(SceneObjectErrors, whatIsOddButPossibleIsAWarning) {
    const SceneDesc scene = read_scene(
        folder_.write("scene.yaml",
                      "uwvdb: 1\n"
                      "camera: {resolution: [64, 48], intrinsics: {fov_x: 60}, port: {distance: "
                      "20}}\n"
                      "volumes: [{file: a.vdb, grids: {d: {small: 0}}}]\n"
                      "lamps: [{position: [0, 0, 0], intensity: 0}]\n"),
        {});
    ASSERT_EQ(scene.warnings.size(), 3U);
    EXPECT_NE(scene.warnings[0].find("camera.port.distance: 20 m is very large"),
              std::string::npos);
    EXPECT_NE(scene.warnings[1].find("volumes[0].grids.d: all concentrations are 0"),
              std::string::npos);
    EXPECT_NE(scene.warnings[2].find("lamps[0].intensity: is 0 in every band"), std::string::npos);
}

}  // namespace
}  // namespace uw
