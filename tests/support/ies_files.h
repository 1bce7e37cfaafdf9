#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace uw::test {

/// Writes an IES file: type C, one lamp, candelas as `candelas(polar, plane)` says, in degrees.
struct IesWriter {
    std::string first_line = "IESNA:LM-63-2002";
    double lumens = -1;
    double multiplier = 1;
    int type = 1;
    std::string tilt = "TILT=NONE";
    double ballast = 1, second = 1;
    std::vector<double> polar, planes{0};
    std::function<double(double polar, double plane)> candelas;

    std::string text() const {
        std::string s = first_line + "\n[MANUFAC] test\n" + tilt + "\n";
        s += "1 " + number(lumens) + " " + number(multiplier) + " " + std::to_string(polar.size()) +
             " " + std::to_string(planes.size()) + " " + std::to_string(type) + " 2 0 0 0\n" +
             number(ballast) + " " + number(second) + " 50\n";
        for (const double angle : polar) s += number(angle) + " ";
        s += "\n";
        for (const double angle : planes) s += number(angle) + " ";
        for (const double plane : planes) {
            s += "\n";
            for (const double angle : polar) s += number(candelas(angle, plane)) + "\n";
        }
        return s + "\n";
    }

    static std::string number(double value) {
        std::string s(32, '\0');
        s.resize(static_cast<std::size_t>(std::snprintf(s.data(), s.size(), "%.12g", value)));
        return s;
    }
};

/// first, first + step, ... to last.
inline std::vector<double> steps(double first, double last, double step) {
    std::vector<double> all;
    for (int i = 0; first + i * step <= last + 1e-9; ++i) all.push_back(first + i * step);
    return all;
}

}  // namespace uw::test
