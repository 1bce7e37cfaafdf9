// ctest labels: unit
#include "tests/support/scene_errors.h"

namespace uw {
namespace {

using test::k_base;
using test::SceneErrors;

TEST_F(SceneErrors, wholeScene) {
    check(
        "",
        {
            {"camera: {}\n", "scene.yaml:1:1: 'uwvdb' is missing; a scene starts with 'uwvdb: 2'"},
            {"uwvdb: 3\ncamra: 1\n",
             "scene.yaml:1:8: uwvdb: this program reads scene versions 1 and 2, found "
             "the number 3; write 'uwvdb: 2'"},
            {"uwvdb: '1'\n",
             "scene.yaml:1:8: uwvdb: this program reads scene versions 1 and 2, found the "
             "quoted text '1'"},
            {"uwvdb: 1.5\n",
             "scene.yaml:1:8: uwvdb: this program reads scene versions 1 and 2, found the "
             "number 1.5"},
            {"uwvdb: 1\n", "scene.yaml:1:1: 'camera' is missing; give camera:"},
            {"uwvdb: 1\ncamra: {}\n", "scene.yaml:2:1: camra: unknown key; did you mean 'camera'?"},
            {"uwvdb: 1\nfoo: {}\n",
             "scene.yaml:2:1: foo: unknown key; use one of: uwvdb, camera, "
             "cameras, rig, water, volumes, geometry, lamps, sky, sensors, render, variations"},
            {"just text\n", "scene.yaml:1:1: expected a map, found the text 'just text'; a scene"},
            {"- 1\n", "scene.yaml:1:1: expected a map, found a list of 1"},
            {"uwvdb: 1\nuwvdb: 1\n",
             "scene.yaml:2:1: uwvdb: the key is given twice (first on line 1)"},
        });
}

TEST_F(SceneErrors, resolutionAndIntrinsics) {
    check("uwvdb: 1\ncamera:\n",
          {
              {"  intrinsics: {fov_x: 60}\n",
               "scene.yaml:3:3: camera: 'resolution' is missing; give "
               "resolution: [width, height] in pixels"},
              {"  resolution: [64, 48]\n", "scene.yaml:3:3: camera: 'intrinsics' is missing"},
              {"", "scene.yaml:2:1: camera: has no value; write {resolution: [1920, 1080]"},
              {"  resolution: 64\n",
               "scene.yaml:3:15: camera.resolution: expected a list of 2, found "
               "the number 64; give [width, height] in pixels"},
              {"  resolution: [64, 48, 3]\n", "expected a list of 2, found a list of 3"},
              {"  resolution: [0, 48]\n",
               "scene.yaml:3:16: camera.resolution[0]: must be from 1 to "
               "32768, found 0"},
              {"  resolution: [64, 48.5]\n",
               "scene.yaml:3:20: camera.resolution[1]: expected a whole "
               "number, found 48.5"},
              {"  resolution: [64, 1e30]\n",
               "camera.resolution[1]: 1e+30 is larger than anything in a scene"},
              {"  resolution: [32768, 32768]\n",
               "scene.yaml:3:15: camera.resolution: 32768 x 32768 are "
               "more than 268435456 pixels"},
              {"  {resolution: [64, 48], intrinsics: {fov_x: 180}}\n",
               "scene.yaml:3:46: camera.intrinsics.fov_x: must lie between 0 and 180, found 180"},
              {"  {resolution: [64, 48], intrinsics: {fov_x: 60, fx: 3}}\n",
               "scene.yaml:3:50: camera.intrinsics.fx: is not used by intrinsics with 'fov_x'; "
               "remove"},
              {"  {resolution: [64, 48], intrinsics: {fx: -3}}\n",
               "scene.yaml:3:43: camera.intrinsics.fx: must be greater than 0, found -3"},
              {"  {resolution: [64, 48], intrinsics: {cx: 3}}\n",
               "camera.intrinsics: 'fx' is missing"},
              {"  {resolution: [64, 48], intrinsics: {fov: 60}}\n",
               "scene.yaml:3:39: camera.intrinsics.fov: unknown key; did you mean 'fov_x'?"},
              {"  {resolution: [64, 48], intrinsics: {fov_x: 60deg}}\n",
               "scene.yaml:3:46: camera.intrinsics.fov_x: expected a number, found '60deg'; write "
               "the "
               "number alone, without a unit (give the horizontal field of view in degrees)"},
              {"  calibration: rig.yaml\n",
               "scene.yaml:3:16: camera.calibration: no such file 'rig.yaml' (looked in "},
              {"  {calibration: sub/a.csv, resolution: [64, 48]}\n",
               "scene.yaml:3:40: camera.resolution: comes from the calibration file; remove it"},
              {"  calibration: {camera: cam0}\n",
               "camera.calibration: 'file' is missing; write calibration: rig.yaml"},
          });
}

TEST_F(SceneErrors, cameraParts) {
    check(
        "uwvdb: 1\ncamera:\n  resolution: [64, 48]\n  intrinsics: {fov_x: 60}\n",
        {
            {"  distortion: {model: fisheye, k: [0, 0, 0]}\n",
             "scene.yaml:5:35: camera.distortion.k: expected 4 numbers, found 3; give k1, k2, k3, "
             "k4"},
            {"  distortion: {model: fisheye, p: [0, 0]}\n",
             "camera.distortion.p: is not used by model 'fisheye'"},
            {"  distortion: {model: fisheye, k: [0, 0, 0, 0], k1: 1}\n",
             "camera.distortion.k1: is not used by model 'fisheye'"},
            {"  distortion: {model: fisheye, k1: -5}\n",
             "camera.intrinsics.fov_x: the distortion folds back before 30 degrees off the axis"},
            {"  distortion: {model: brown}\n",
             "unknown value 'brown'; did you mean 'brown-conrady'?"},
            {"  distortion: {k: [1, 2]}\n",
             "camera.distortion.k: expected 3 to 6 numbers, found 2"},
            {"  distortion: {k1: 1}\n",
             "camera.distortion.k1: is not used by model 'brown-conrady'"},
            {"  distortion: {p: [1, 2, 3]}\n", "camera.distortion.p: expected a list of 2, found"},
            {"  port: {type: dome}\n",
             "scene.yaml:5:9: camera.port: 'radius' is missing; give the radius of the inner"},
            {"  port: {type: dome, radius: 0}\n",
             "camera.port.radius: must be greater than 0, found 0"},
            {"  port: {type: dome, radius: 0.05, distance: 0.1}\n",
             "camera.port.distance: is not used by type 'dome'; remove it"},
            {"  port: {type: dome, radius: 0.05, center: [0, 0.04, 0.03]}\n",
             "scene.yaml:5:9: camera.port: the camera is outside its dome: it is 0.05 m from the "
             "centre, but the inner radius is 0.05 m"},
            {"  port: {normal: [0, 0, 0]}\n", "camera.port.normal: [0, 0, 0] has no direction"},
            {"  port: {normal: [0, 0, -1]}\n",
             "camera.port.normal: must point away from the camera"},
            {"  port: {thickness: -0.1}\n",
             "scene.yaml:5:21: camera.port.thickness: must not be "
             "negative, found -0.1; give a length in metres"},
            {"  port: {n_glass: 0.9}\n", "camera.port.n_glass: must be from 1 to 3, found 0.9"},
            {"  port: {radius: 1}\n", "camera.port.radius: is not used by type 'flat'; remove it"},
            {"  port: {fresnel: 1}\n",
             "scene.yaml:5:19: camera.port.fresnel: unknown value '1'; use one of: true, false"},
            {"  port: {radiance_in: glass}\n",
             "camera.port.radiance_in: unknown value 'glass'; use one of: water, air"},
            {"  line_time: 15\n",
             "camera.line_time: 15 looks like microseconds, or like the readout of all rows; give "
             "seconds from row to row, such as 15e-6"},
            {"  line_time: -1e-6\n", "camera.line_time: must not be negative"},
            {"  linetime: 1e-6\n", "camera.linetime: unknown key; did you mean 'line_time'?"},
            {"  lens: {f_number: 2.8, focal_length: 8.5}\n",
             "camera.lens.focal_length: 8.5 looks like millimetres; give metres (0.0085)"},
            {"  lens: {f_number: 0, focal_length: 0.01}\n",
             "camera.lens.f_number: must be greater"},
            {"  pose: {position: [0, 0, 0]}\n",
             "scene.yaml:5:9: camera.pose: 'look_at' is missing"},
            {"  pose: {position: [1, 2, 3], look_at: [1, 2, 3]}\n",
             "scene.yaml:5:40: camera.pose.look_at: is the camera's own position; give another "
             "point"},
            {"  pose: {look_at: [0, 3, 0]}\n",
             "camera.pose.look_at: up [0, 1, 0] is parallel to the "
             "view direction; give another 'up'"},
            {"  pose: {look_at: [0, 0, 3], up: [0, 0, 5]}\n",
             "scene.yaml:5:34: camera.pose.up: up"},
            {"  pose: {matrix: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]}\n",
             "scene.yaml:5:18: camera.pose.matrix: is not rigid"},
            {"  pose: {matrix: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]}\n",
             "camera.pose.matrix: mirrors the world (determinant -1)"},
            {"  pose: {matrix: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [1, 0, 0, 1]]}\n",
             "camera.pose.matrix[3]: the last row must be [0, 0, 0, 1]"},
            {"  pose: {matrix: [[1e9, 0, 0, 0], [0, 1e9, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}\n",
             "camera.pose.matrix: is not rigid"},
            {"  pose: {matrix: [1, 0, 0, 0]}\n",
             "camera.pose.matrix[0]: expected a list of 4, found "
             "the number 1; give world_from_camera as four rows"},
        });
}

TEST_F(SceneErrors, water) {
    check(
        std::string(k_base) + "water:\n",
        {
            {"  bnds: [1]\n", "scene.yaml:4:3: water.bnds: unknown key; did you mean 'bands'?"},
            {"  bands: []\n", "scene.yaml:4:10: water.bands: expected 1 to 32 bands, found 0"},
            {"  bands: [0.62]\n",
             "scene.yaml:4:11: water.bands[0]: 0.62 looks like micrometres; give "
             "nanometres (620)"},
            {"  bands: [500, 5000]\n", "water.bands[1]: must be from 200 to 1100, found 5000"},
            {"  bands: [500, 500.0]\n", "water.bands[1]: 500 nm is given twice; remove one"},
            {"  bands: 500\n", "water.bands: expected a list, found the number 500"},
            {"  preset: jerlov-VI\n",
             "water.preset: unknown value 'jerlov-VI'; did you mean 'jerlov-"},
            {"  salinity: abc\n",
             "scene.yaml:4:13: water.salinity: expected a number, found the text "
             "'abc'; give the salinity in PSU"},
            {"  salinity: '35'\n", "water.salinity: expected a number, found the quoted text '35'"},
            {"  salinity: 3,5\n",
             "water.salinity: expected a number, found '3,5'; write the decimal"},
            {"  salinity: .nan\n", "water.salinity: .nan is not a finite number"},
            {"  salinity: -inf\n", "water.salinity: -inf is not a finite number"},
            {"  salinity: 1e999\n", "water.salinity: 1e999 is too large or too small for a number"},
            {"  salinity:\n", "scene.yaml:4:3: water.salinity: has no value; give the salinity"},
            {"  temperature: 300\n", "water.temperature: must be from -3 to 50, found 300"},
            {"  absorption: [0.1, -0.2, 0.3]\n",
             "scene.yaml:4:21: water.absorption[1]: must not be "
             "negative, found -0.2"},
            {"  absorption: [0.1, 0.2]\n",
             "scene.yaml:4:15: water.absorption: has 2 values, but "
             "water.bands has 3; give one value per band"},
            {"  {absorption: 1, cdom: 1}\n",
             "water.cdom: 'absorption' already includes dissolved matter"},
            {"  {preset: jerlov-II, chlorophyll: 1}\n",
             "water.chlorophyll: the preset already includes dissolved"},
            {"  particles: {small: -1}\n", "water.particles.small: must be from 0 to 1000000"},
            {"  particles: {absorption: minral}\n",
             "unknown value 'minral'; did you mean 'mineral'?"},
            {"  scattering: {b: 1, phase: {type: hg, g: 1}}\n",
             "water.scattering.phase.g: must lie between -1 and 1, found 1"},
            {"  scattering: {b: 1}\n", "water.scattering: 'phase' is missing"},
            {"  scattering: {b: 1, phase: petzold}\n",
             "water.scattering.phase: expected a map, found "
             "the text 'petzold'; write {type: hg, g: 0.9}"},
            {"  scattering: {b: 1, phase: {type: petzold, g: 0.5}}\n",
             "water.scattering.phase.g: is not used by phase type 'petzold'; remove it"},
            {"  scattering: {b: 1, phase: {type: fournier-forand, n: 1, mu: 4}}\n",
             "water.scattering.phase.n: must be greater than 1"},
            {"  scattering: {b: 1, phase: {type: fournier-forand, mu: 5}}\n",
             "water.scattering.phase.mu: must lie between 3 and 5, found 5"},
            {"  scattering: {b: 1, phase: {type: table, file: a.csv}}\n",
             "water.scattering.phase.file: no such file 'a.csv' (looked in "},
            {"  {scattering: {b: 1, phase: {type: water}}, particles: {small: 1}}\n",
             "water.particles: 'scattering' takes the place of background particles"},
            {"  forward_scatter: {K: 0.5}\n",
             "scene.yaml:4:20: water.forward_scatter: has no B, the width of the blur in rad/m; "
             "write {K: 1, G: 0.1, B: 0.02}"},
            {"  forward_scatter: {K: -1, B: 0.1}\n", "water.forward_scatter.K: "},
            {"  forward_scatter: {K: 0, shape: gauss}\n",
             "water.forward_scatter.shape: unknown value"},
        });
}

}  // namespace
}  // namespace uw
