#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "camera/calibration.h"
#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"

namespace uw::test {

/// Reads calibrations that a test writes down.
class CalibrationReading : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    Calibration read(const std::string& text, const std::string& camera = "") const {
        return read_calibration(write("c.yaml", text), camera);
    }
    /// Expects that `text` is refused with one line that contains `part`.
    void expect_refused(const std::string& text, const std::string& part,
                        const std::string& camera = "") const {
        const std::string found = message_of<InputError>([&] { read(text, camera); });
        EXPECT_NE(found.find(part), std::string::npos)
            << text << "\n  gave:     " << found << "\n  expected: " << part;
    }
    TempDir folder_;
};

/// `text` with its first `from` replaced by `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

}  // namespace uw::test
