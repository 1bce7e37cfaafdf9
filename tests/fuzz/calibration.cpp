#include "camera/calibration.h"
#include "tests/fuzz/fuzzing.h"

// Calibrations; the content decides which of the formats it is. What can be read can be written.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    static const fuzz::InputFolder folder;
    const std::filesystem::path file = folder.write("camera", fuzz::text_of(data, size));
    fuzz::parse([&] {
        const Calibration calibration = read_calibration(file);
        for (const CalibrationFormat format : calibration_formats())
            if (calibration_obstacle(format, calibration.desc).empty())
                write_calibration(format, calibration.desc);
    });
    return 0;
}
