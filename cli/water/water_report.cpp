#include "cli/water/water_report.h"

namespace uw {

const std::vector<double>& printed_angles() {
    static const std::vector<double> k_angles{0.1, 0.2, 0.5, 1,  2,   5,   10,  15,  20,  30,
                                              45,  60,  75,  90, 105, 120, 135, 150, 165, 180};
    return k_angles;
}

const std::vector<double>& file_angles() {
    static const std::vector<double> k_angles = [] {
        std::vector<double> angles;
        angles.reserve(10 + 9 + 180);
        for (int i = 0; i < 10; ++i) angles.push_back(i / 100.0);
        for (int i = 1; i < 10; ++i) angles.push_back(i / 10.0);
        for (int i = 1; i <= 180; ++i) angles.push_back(i);
        return angles;
    }();
    return k_angles;
}

}  // namespace uw
