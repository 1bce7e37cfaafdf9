#include <pybind11/stl.h>

#include "cli/validate/validation.h"
#include "python/bindings.h"
#include "python/scene_object.h"
#include "python/signals.h"
#include "render/resolved_scene.h"

namespace py = pybind11;

namespace uw {

namespace {

py::dict check_of(const Check& check, const std::vector<double>& bands_nm) {
    py::dict dict;
    dict["left"] = check.left;
    dict["right"] = check.right;
    dict["component"] = check.component.name;
    dict["band"] = bands_nm[check.band];
    dict["largest"] = check.largest;
    dict["rms"] = check.rms;
    dict["tolerance"] = check.tolerance;
    dict["passed"] = check.passed();
    return dict;
}

py::list validate(const SceneObject& scene, double tolerance, std::size_t camera,
                  std::optional<int> frame) {
    SceneDesc desc = *scene.desc();
    desc.water.snow.reset();  // particles do not depend on the method
    WatchedTask task;
    ValidationOptions options;
    options.tolerance = tolerance;
    options.proceed = [&task] { return task.tell("validation", 0); };
    SceneValidation validation;
    run_interruptible(task, [&] {
        validation = validate_scene(scene_of_image(desc, {frame, camera}),
                                    desc.file.filename().string(), options);
    });
    py::list checks;
    for (const Check& check : validation.checks)
        checks.append(check_of(check, validation.bands_nm));
    return checks;
}

}  // namespace

void bind_validate(py::module_& module) {
    module.def("validate", validate, py::arg("scene"), py::arg("tolerance"), py::arg("camera"),
               py::arg("frame"));
}

}  // namespace uw
