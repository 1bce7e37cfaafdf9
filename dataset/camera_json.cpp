#include "dataset/camera_json.h"

#include "core/scene/trajectory.h"

namespace uw {

namespace {

Vector3 vector_from(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

PortDesc port_from(const Json& json) {
    const auto read_glass = [&json](auto& p) {
        json.at("thickness").get_to(p.thickness);
        json.at("n_air").get_to(p.n_air);
        json.at("n_glass").get_to(p.n_glass);
        json.at("n_water").get_to(p.n_water);
    };
    if (json.at("type") == "flat") {
        FlatPortDesc flat;
        flat.normal = vector_from(json.at("normal"));
        json.at("distance").get_to(flat.distance);
        read_glass(flat);
        return flat;
    }
    DomePortDesc dome;
    dome.center = at_origin_plus(vector_from(json.at("center")));
    json.at("radius").get_to(dome.radius);
    read_glass(dome);
    return dome;
}

}  // namespace

Json port_json(const PortDesc& port) {
    Json json;
    const auto add_glass = [&json](const auto& p) {
        json["thickness"] = p.thickness;
        json["n_air"] = p.n_air;
        json["n_glass"] = p.n_glass;
        json["n_water"] = p.n_water;
    };
    if (const auto* flat = std::get_if<FlatPortDesc>(&port)) {
        json = {
            {"type", "flat"}, {"normal", vector_json(flat->normal)}, {"distance", flat->distance}};
        add_glass(*flat);
    } else {
        const auto& dome = std::get<DomePortDesc>(port);
        json = {{"type", "dome"}, {"center", point_json(dome.center)}, {"radius", dome.radius}};
        add_glass(dome);
    }
    return json;
}

Json camera_json(const CameraDesc& camera) {
    const IntrinsicsDesc& k = camera.intrinsics;
    const DistortionDesc& d = camera.distortion;
    const Affine& pose = camera.world_from_camera;
    const Rotation q = pose_of(pose).rotation;
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row)
        rows.push_back({pose.linear()[0][row], pose.linear()[1][row], pose.linear()[2][row],
                        pose.offset()[row]});
    const bool is_fisheye = d.model == DistortionDesc::Model::fisheye;
    Json port = camera.port ? port_json(*camera.port) : Json(nullptr);
    if (disperses(camera)) port["wavelength_nm"] = camera.wavelength_nm;
    return {{"width", camera.width},
            {"height", camera.height},
            {"fx", k.fx},
            {"fy", k.fy},
            {"cx", k.cx},
            {"cy", k.cy},
            {"model", is_fisheye ? "fisheye" : "brown-conrady"},
            {"k", d.k},
            {"p", d.p},
            {"port", port},
            {"position", vector_json(pose.offset())},
            {"rotation_wxyz", {q.w, q.x, q.y, q.z}},
            {"world_from_camera", rows}};
}

CameraDesc camera_from_json(const Json& json) {
    CameraDesc camera;
    json.at("width").get_to(camera.width);
    json.at("height").get_to(camera.height);
    json.at("fx").get_to(camera.intrinsics.fx);
    json.at("fy").get_to(camera.intrinsics.fy);
    json.at("cx").get_to(camera.intrinsics.cx);
    json.at("cy").get_to(camera.intrinsics.cy);
    if (json.at("model") == "fisheye") camera.distortion.model = DistortionDesc::Model::fisheye;
    json.at("k").get_to(camera.distortion.k);
    json.at("p").get_to(camera.distortion.p);
    if (!json.at("port").is_null()) {
        camera.port = port_from(json.at("port"));
        camera.wavelength_nm = json.at("port").value("wavelength_nm", camera.wavelength_nm);
    }
    Matrix3 linear;
    Vector3 offset;
    for (int row = 0; row < 3; ++row) {
        const Json& values = json.at("world_from_camera").at(static_cast<std::size_t>(row));
        for (int column = 0; column < 3; ++column)
            linear[column][row] = values.at(static_cast<std::size_t>(column)).get<double>();
        offset[row] = values.at(3).get<double>();
    }
    camera.world_from_camera = {linear, offset};
    return camera;
}

}  // namespace uw
