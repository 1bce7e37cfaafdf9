#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene_desc.h"
#include "render/navigation/vehicle_motion.h"

namespace uw {

/// What a sensor has recorded: its readings, and beside them the truth.
struct SensorRecord {
    std::string note;                   // the units of the columns, one line
    std::vector<std::string> columns;   // of measured values, then of true ones, "..._true"
    std::vector<std::int64_t> numbers;  // of the readings: n is at n / update_rate [s]
    std::vector<double> values;         // row by row; not a number: none, such as of a lost beam

    void add(std::int64_t number, std::initializer_list<double> row) {
        numbers.push_back(number);
        values.insert(values.end(), row);
    }
};

/// Records the readings `range` of a sensor of the scene's vehicle. `whole`: the scene as it was
/// read. Each reading depends on its number alone. Throws InputError for a scene that the sensor
/// cannot work in; as Renderer for echoes; Interrupted.
SensorRecord record_sensor(const SceneDesc& whole, const NavigationSensorDesc& sensor,
                           const ReadingRange& range);

}  // namespace uw
