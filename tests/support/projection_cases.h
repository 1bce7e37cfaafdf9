#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "camera/camera.h"

namespace uw::test {

/// Every lens without a port and behind every port it makes sense with, posed anywhere.
inline std::vector<std::pair<std::string, CameraDesc>> projection_cameras() {
    CameraDesc pinhole;
    pinhole.width = 1920;
    pinhole.height = 1080;
    pinhole.intrinsics = {1100, 1105, 955, 548};
    pinhole.world_from_camera =
        Affine::translation({3, -2, 5}) * Affine::rotation_xyz_degrees({20, -35, 70});
    CameraDesc brown = pinhole;
    brown.distortion = {{-0.12, 0.06, -0.01, 0.01, 0.002, 0}, {0.001, -0.0005}};
    CameraDesc fisheye = pinhole;
    fisheye.intrinsics = {480, 482, 955, 548};  // the image's corners lie beyond 110 degrees
    fisheye.distortion = {{0.03, -0.005, 0.001, -0.0002, 0, 0}, {}, DistortionDesc::Model::fisheye};
    FlatPortDesc flat;
    flat.normal = glm::normalize(Vector3(0.08, -0.05, 1));
    flat.distance = 0.02;
    flat.thickness = 0.04;
    DomePortDesc dome;
    dome.center = {0.004, -0.003, -0.011};
    dome.radius = 0.05;
    dome.thickness = 0.007;

    std::vector<std::pair<std::string, CameraDesc>> cameras;
    for (const auto& [name, lens] : {std::pair{std::string("pinhole"), pinhole},
                                     {std::string("brown-conrady"), brown},
                                     {std::string("fisheye"), fisheye}}) {
        cameras.emplace_back(name, lens);
        cameras.emplace_back(name + ", flat", lens).second.port = flat;
        cameras.emplace_back(name + ", dome", lens).second.port = dome;
    }
    return cameras;
}

struct ProjectionTally {
    int points = 0, failures = 0;
    double worst = 0;  // pixels
};

/// Points on the water rays of random image positions, 0.1 m to 100 m from where the ray enters
/// the water (as many in each octave), projected back.
inline ProjectionTally tally_projections(const CameraDesc& desc, int count) {
    const Camera camera(desc);
    std::mt19937_64 random(20240229);
    std::uniform_real_distribution<double> x(0, desc.width), y(0, desc.height),
        exponent(std::log(0.1), std::log(100.0));
    ProjectionTally tally;
    while (tally.points < count) {
        const double u = x(random), v = y(random), distance = std::exp(exponent(random));
        const auto ray = camera.refracted_ray(u, v);
        if (!ray) continue;  // a flat port has a narrower field than a fisheye
        ++tally.points;
        const auto seen = camera.project(ray->at(distance));
        if (!seen) {
            ++tally.failures;
            continue;
        }
        tally.worst = std::max(tally.worst, std::hypot(seen->x - u, seen->y - v));
    }
    return tally;
}

}  // namespace uw::test
