#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/meshes/mesh_fixtures.h"

namespace uw::test {

/// Collects the accessors of a small glTF, each with a view of its own, in one embedded buffer.
class GltfBuilder {
  public:
    /// Adds an accessor and returns its number, as JSON text. `more`: further members of it.
    std::string add(const std::string& type, const std::vector<float>& values,
                    const std::string& more = "") {
        return add(type, 5126, values.size(), bytes_of(values), more);
    }
    std::string add_bytes(const std::string& type, const std::vector<std::uint8_t>& values,
                          const std::string& more = "") {
        return add(type, 5121, values.size(), bytes_of(values), more);
    }
    std::string add_shorts(const std::string& type, const std::vector<std::uint16_t>& values) {
        return add(type, 5123, values.size(), bytes_of(values), "");
    }
    /// The times of keys, with the bounds that the format asks for.
    std::string add_times(const std::vector<float>& times) {
        return add("SCALAR", times,
                   ",\"min\":[" + std::to_string(times.front()) + "],\"max\":[" +
                       std::to_string(times.back()) + "]");
    }

    /// The whole file; `rest` are its other members.
    std::string text(const std::string& rest) const {
        return R"({"asset":{"version":"2.0"},)" + rest + R"(,"accessors":[)" + accessors_ +
               R"(],"bufferViews":[)" + views_ + R"(],"buffers":[{"byteLength":)" +
               std::to_string(buffer_.size()) + R"(,"uri":"data:application/octet-stream;base64,)" +
               base64(buffer_) + "\"}]}";
    }

  private:
    std::string add(const std::string& type, int component, std::size_t values,
                    const std::string& bytes, const std::string& more) {
        const std::size_t width = type == "SCALAR" ? 1
                                  : type == "MAT4" ? 16
                                                   : static_cast<std::size_t>(type.back() - '0');
        const std::string comma = count_ == 0 ? "" : ",";
        accessors_ += comma + R"({"bufferView":)" + std::to_string(count_) +
                      R"(,"componentType":)" + std::to_string(component) + R"(,"count":)" +
                      std::to_string(values / width) + R"(,"type":")" + type + "\"" + more + "}";
        views_ += comma + R"({"buffer":0,"byteOffset":)" + std::to_string(buffer_.size()) +
                  R"(,"byteLength":)" + std::to_string(bytes.size()) + "}";
        buffer_ += bytes;
        buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
        return std::to_string(count_++);
    }

    int count_ = 0;
    std::string accessors_, views_, buffer_;
};

}  // namespace uw::test
