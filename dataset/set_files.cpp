#include "dataset/set_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/output_files.h"

namespace uw {

namespace {

constexpr std::array<std::uint32_t, 64> k_sha256_constants{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

}  // namespace

void Sha256::add_block(const std::byte* block) {
    std::array<std::uint32_t, 64> w;
    for (std::size_t t = 0; t < 16; ++t) {
        w[t] = 0;
        for (std::size_t i = 0; i < 4; ++i)
            w[t] = w[t] << 8 | std::to_integer<std::uint32_t>(block[4 * t + i]);
    }
    for (std::size_t t = 16; t < 64; ++t) {
        const std::uint32_t a = w[t - 15], b = w[t - 2];
        w[t] = w[t - 16] + w[t - 7] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ a >> 3) +
               (std::rotr(b, 17) ^ std::rotr(b, 19) ^ b >> 10);
    }
    auto [a, b, c, d, e, f, g, h] = state_;
    for (std::size_t t = 0; t < 64; ++t) {
        const std::uint32_t t1 = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                                 ((e & f) ^ (~e & g)) + k_sha256_constants[t] + w[t];
        const std::uint32_t t2 =
            (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
        h = g;
        g = f;
        f = e;
        e = d + t1;
        d = c;
        c = b;
        b = a;
        a = t1 + t2;
    }
    const std::array<std::uint32_t, 8> added{a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < added.size(); ++i) state_[i] += added[i];
}

void Sha256::add(std::span<const std::byte> bytes) {
    const std::size_t begun = size_ % block_.size();
    size_ += bytes.size();
    if (begun > 0) {
        const std::size_t count = std::min(block_.size() - begun, bytes.size());
        std::copy_n(bytes.begin(), count, block_.begin() + static_cast<std::ptrdiff_t>(begun));
        bytes = bytes.subspan(count);
        if (begun + count < block_.size()) return;
        add_block(block_.data());
    }
    for (; bytes.size() >= block_.size(); bytes = bytes.subspan(block_.size()))
        add_block(bytes.data());
    std::ranges::copy(bytes, block_.begin());
}

std::string Sha256::digest() {
    const std::uint64_t bits = 8 * size_;
    const std::size_t begun = size_ % block_.size();
    constexpr std::size_t k_place_of_size = 56;
    std::vector<std::byte> end((begun < k_place_of_size ? 1 : 2) * block_.size() - begun,
                               std::byte{0});
    end.front() = std::byte{0x80};
    for (std::size_t i = 0; i < 8; ++i)
        end[end.size() - 1 - i] = static_cast<std::byte>(bits >> 8 * i & 0xff);
    add(end);
    std::string text;
    for (const std::uint32_t word : state_) text += fmt::format("{:08x}", word);
    return text;
}

std::string sha256_of(std::string_view text) {
    Sha256 sum;
    sum.add(text);
    return sum.digest();
}

std::string sha256_of_file(const std::filesystem::path& file) {
    std::ifstream in = open_own_file(file);
    std::vector<char> part(1 << 16);
    Sha256 sum;
    while (in) {
        throw_if_stopped();
        in.read(part.data(), static_cast<std::streamsize>(part.size()));
        sum.add(std::string_view(part.data(), static_cast<std::size_t>(in.gcount())));
    }
    if (!in.eof()) throw IoError(fmt::format("{}: cannot be read", file.string()));
    return sum.digest();
}

namespace fs = std::filesystem;

Json set_file_json(const SetFile& file) {
    return {
        {"role", file.role}, {"path", file.path}, {"bytes", file.bytes}, {"sha256", file.sha256}};
}

SetFile set_file_from_json(const Json& json) {
    return {json.at("role").get<std::string>(), json.at("path").get<std::string>(),
            json.at("bytes").get<std::uint64_t>(), json.at("sha256").get<std::string>()};
}

bool is_whole(const fs::path& folder, const SetFile& file, bool by_content) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(folder / file.path, error);
    if (error || size != file.bytes) return false;
    return !by_content || sha256_of_file(folder / file.path) == file.sha256;
}

void SetFiles::add(std::string role, std::string path,
                   const std::function<void(const fs::path& file)>& write) {
    const fs::path file = folder_ / path;
    write(file);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) throw IoError(fmt::format("{}: {}", file.string(), error.message()));
    written_.push_back({std::move(role), std::move(path), size, sha256_of_file(file)});
}

void SetFiles::add_bytes(std::string role, std::string path, std::string_view bytes) {
    OutputFile out(folder_ / path);
    out.write(bytes);
    out.commit();
    written_.push_back({std::move(role), std::move(path), bytes.size(), sha256_of(bytes)});
}

void SetFiles::add_copy(std::string role, std::string path, const std::string& from) {
    std::ifstream in = open_own_file(folder_ / from);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw IoError(fmt::format("{}: cannot be read", (folder_ / from).string()));
    add_bytes(std::move(role), std::move(path), bytes);
}

}  // namespace uw
