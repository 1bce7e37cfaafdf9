// ctest labels: unit
// How much of an image is written once its thread's work is to stop.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <iterator>
#include <random>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/contact_sheet.h"
#include "core/image/image_file.h"
#include "core/image/jpeg_file.h"
#include "core/image/png_file.h"
#include "core/image/preview_exposure.h"
#include "tests/support/faults/stop_at_size.h"
#include "tests/support/full_disk.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

// What libraries and streams hold back and write at once.
constexpr std::uint64_t k_buffers = 64 << 10;

/// Noise, which nothing compresses.
Film noisy_film(int width, int height) {
    Film film(width, height, {0, 0, width, height}, {"R", "G", "B", "A", "a.Y", "b.Y", "c.Y"});
    std::mt19937 random(1);
    std::uniform_real_distribution<float> value(1, 2);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (float& v : film.pixel(x, y)) v = value(random);
    return film;
}

class StoppedWriting : public testing::Test {
  protected:
    /// Writes a file of more than twice `until` bytes that is to stop there; returns how many bytes
    /// follow.
    template <class Write>
    std::uint64_t written_after(std::uint64_t until, const Write& write) {
        OutputFile out(folder_ / "image");
        EXPECT_THROW(test::stopped_at_size(until, [&] { write(out); }), Interrupted);
        EXPECT_GE(out.position(), until);
        return out.position() - until;
    }
    std::ptrdiff_t file_count() const {
        return std::distance(std::filesystem::directory_iterator(folder_.path()), {});
    }

    test::TempDir folder_;
};

constexpr ExrOptions k_floats{.precision = ExrOptions::Precision::single};

TEST_F(StoppedWriting, OfAnExrEndsWithItsPortion) {
    const Film film = noisy_film(1024, 1024);  // 29 MB
    const ThreadLimit limit(1);
    EXPECT_LE(
        written_after(2'000'000, [&](OutputFile& out) { write_exr(out, film, {}, k_floats); }),
        1'500'000 * sizeof(float) + k_buffers);
    EXPECT_EQ(file_count(), 0);
    const Film wide = noisy_film(30'000, 40);  // 34 MB; 16 lines are 3.4 million values
    EXPECT_LE(
        written_after(2'000'000, [&](OutputFile& out) { write_exr(out, wide, {}, k_floats); }),
        16 * 30'000 * 7 * sizeof(float) + k_buffers);
    EXPECT_EQ(file_count(), 0);
}

TEST_F(StoppedWriting, OfAPngEndsWithARow) {
    const Film film = noisy_film(2048, 512);
    DigitalImage camera{2048, 512, 1, 16, false, {}};
    std::mt19937 random(1);
    for (int i = 0; i < 2048 * 512; ++i)
        camera.values.push_back(static_cast<std::uint16_t>(random()));
    const std::uint64_t row = 2048 * 3 * sizeof(std::uint16_t);
    const auto preview = make_preview16(film, 0.3);
    EXPECT_LE(written_after(500'000, [&](OutputFile& out) { write_png_file(out, preview, {}); }),
              row + k_buffers);
    EXPECT_LE(written_after(500'000, [&](OutputFile& out) { write_png_file(out, camera, {}); }),
              row + k_buffers);
    EXPECT_EQ(file_count(), 0);
}

// The bytes of these files are written once there are all of them; what is made of films before
// stops as well.
TEST_F(StoppedWriting, DoesNotBeginWhereItIsToStop) {
    const Film film = noisy_film(300, 300);
    const auto preview = make_preview(film, 0.3);
    const DigitalImage grey{8, 8, 1, 8, false, std::vector<std::uint16_t>(64)};
    write_png(folder_ / "picture.png", preview, {});
    const std::filesystem::path pictures[] = {folder_ / "picture.png"};
    OutputFile jpeg(folder_ / "image.jpg");
    const std::atomic<bool> stop = true;
    const StopScope scope(stop);
    EXPECT_THROW(write_jpeg_file(jpeg, grey, 90, {}), Interrupted);
    EXPECT_THROW(write_exr(folder_ / "image.exr", film, {}), Interrupted);
    EXPECT_THROW(write_png(folder_ / "image.png", preview, {}), Interrupted);
    EXPECT_THROW(make_preview(film, 1), Interrupted);
    EXPECT_THROW(automatic_exposure(film), Interrupted);
    EXPECT_THROW(half_loss(film), Interrupted);
    EXPECT_THROW(cropped(film, {0, 0, 3, 3}), Interrupted);
    EXPECT_THROW(with_channels(film, {"R"}, film.window()), Interrupted);
    EXPECT_THROW(contact_sheet(pictures, 1), Interrupted);
    EXPECT_EQ(jpeg.position(), 0U);
    EXPECT_EQ(file_count(), 2);  // the picture, and where the JPEG would have been written
}

TEST_F(StoppedWriting, FilesOfAGroupAppearTogether) {
    OutputGroup group;
    group.add(folder_ / "a").write("one");
    group.add(folder_ / "b").write("two");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a"));
    group.commit();
    EXPECT_EQ(std::filesystem::file_size(folder_ / "a"), 3U);
    EXPECT_EQ(std::filesystem::file_size(folder_ / "b"), 3U);
    EXPECT_EQ(file_count(), 2);
    const auto write_large = [&] {
        OutputGroup large;
        large.add(folder_ / "c").write("three");
        large.add(folder_ / "d").write(std::string(10'000, 'd'));
        large.commit();
    };
    EXPECT_THROW(test::limited(5000, write_large), IoError);
    EXPECT_EQ(file_count(), 2);
    {
        OutputGroup elsewhere;
        elsewhere.add(folder_ / "new/folder/e");
        elsewhere.add(folder_ / "new/folder/f");
        EXPECT_TRUE(std::filesystem::exists(folder_ / "new/folder"));
    }
    EXPECT_EQ(file_count(), 2);  // not even the folders
}

}  // namespace
}  // namespace uw
