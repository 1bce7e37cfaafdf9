// ctest labels: unit threads
#include "render/run/run_engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// Scenes whose lamp is as bright as their number, with one warning that all have and one of their
/// own.
SceneDesc scene_of(int number) {
    SceneDesc scene = pinhole_scene(8, 6);
    scene.water = hg_water(0.8);
    scene.geometry = {plane_at_z(2)};
    scene.lamps = {isotropic_lamp({0.2, 0, 0}, number)};
    scene.warnings = {"the same", "scene " + std::to_string(number)};
    return scene;
}

/// Keeps what it is told, and the films.
class Recorder : public RunClient {
  public:
    WantedImage want(std::size_t place, ImageScene& /*scene*/) override {
        told.push_back("want " + std::to_string(place));
        return {{.layers = "depth"}};
    }
    void loaded(std::size_t place) override { told.push_back("loaded " + std::to_string(place)); }
    ImageWork take(std::size_t place, FinishedImage image) override {
        told.push_back("take " + std::to_string(place));
        films.push_back(std::move(image.film));
        return {[this, place] { write(place); },
                [this, place] { told.push_back("written " + std::to_string(place)); }};
    }
    void warn(std::size_t place, const std::string& line) override {
        warnings.push_back(std::to_string(place) + ": " + line);
    }
    void tell(Stage /*stage*/, double /*fraction*/) override {
        if (films.size() >= stop_after) stop = true;
    }

    std::vector<std::string> told, warnings;
    std::vector<Film> films;
    std::function<void(std::size_t place)> write = [](std::size_t) {};
    std::size_t stop_after = 100;  // images
    std::atomic<bool> stop = false;
};

std::vector<JobImage> images_of_scenes(std::initializer_list<int> numbers) {
    std::vector<JobImage> images;
    for (const int number : numbers) images.push_back({number, {}});
    return images;
}

std::size_t place_of(const Recorder& client, const std::string& what) {
    return static_cast<std::size_t>(std::ranges::find(client.told, what) - client.told.begin());
}

TEST(RunEngine, HandsOverAllImagesAsTheyAre) {
    JobScenes scenes(scene_of);
    Recorder client;
    RunEngine engine;
    engine.run({scenes, images_of_scenes({3, 1, 2})}, client);
    EXPECT_EQ(engine.written(), 3U);
    ASSERT_EQ(client.films.size(), 3U);
    for (const auto& [place, number] : {std::pair{0U, 3}, {1U, 1}, {2U, 2}}) {
        Renderer alone;
        alone.set_scene(scene_of(number));
        EXPECT_TRUE(std::ranges::equal(client.films[place].values(),
                                       alone.render({.layers = "depth"}).values()));
    }
    const std::vector<std::string> first{"want 0", "loaded 0", "take 0"};
    EXPECT_TRUE(std::ranges::equal(first, std::span(client.told).first(3)));
    for (const char* place : {"0", "1", "2"}) {
        const std::size_t written = place_of(client, std::string("written ") + place);
        EXPECT_LT(written, client.told.size());
        EXPECT_GT(written, place_of(client, std::string("take ") + place));
    }
}

/// Memory is short for so many readings, in seconds that pass at once.
struct Shortage {
    explicit Shortage(int readings) : left(readings) {
        wait.read = [this]() -> FreeMemory {
            constexpr std::uint64_t k_little = 1'000'000, k_much = 64'000'000'000;
            return {left-- > 0 ? k_little : k_much, k_much, k_much};
        };
        wait.sleep = [this](double seconds) { slept += seconds; };
    }
    int left;
    double slept = 0;
    MemoryWait wait;
};

TEST(RunEngine, OutlastsAShortageOfMemory) {
    JobScenes scenes(scene_of);
    Recorder client;
    RunEngine engine;
    Shortage shortage(30);
    const MemoryWaitScope scope(shortage.wait);
    engine.run({scenes, images_of_scenes({3, 1})}, client);
    EXPECT_EQ(engine.written(), 2U);
    EXPECT_GT(shortage.slept, 1);
    const auto is_of_memory = [](const std::string& line) {
        return line.find("but only 0.001 GB are free") != std::string::npos &&
               line.ends_with("it is tried again for 60 s");
    };
    EXPECT_EQ(std::ranges::count_if(client.warnings, is_of_memory), 1);
    for (const auto& [place, number] : {std::pair{0U, 3}, {1U, 1}}) {
        Renderer alone;
        alone.set_scene(scene_of(number));
        EXPECT_TRUE(std::ranges::equal(client.films[place].values(),
                                       alone.render({.layers = "depth"}).values()));
    }
}

TEST(RunEngine, EndsWithALastingShortageOfMemory) {
    JobScenes scenes(scene_of);
    Recorder client;
    RunEngine engine;
    Shortage shortage(1'000'000);
    const MemoryWaitScope scope(shortage.wait);
    EXPECT_THROW(engine.run({scenes, images_of_scenes({3, 1})}, client), OutOfMemory);
    EXPECT_GE(shortage.slept, 60);
    // A single image is not worth a minute.
    shortage.slept = 0;
    EXPECT_THROW(engine.run({scenes, images_of_scenes({3})}, client), OutOfMemory);
    EXPECT_LT(shortage.slept, 5);
}

// What nobody reads is not computed; what is read belongs to the first image.
TEST(RunEngine, LooksForLightLeftOutWhereItIsRead) {
    for (const bool is_read : {false, true}) {
        class Reader : public Recorder {
          public:
            explicit Reader(bool reads) : reads_(reads) {}
            bool reads_light_note() const override { return reads_; }
            ImageWork take(std::size_t place, FinishedImage image) override {
                notes.push_back(image.report.light_note);
                return Recorder::take(place, std::move(image));
            }
            std::vector<std::string> notes;

          private:
            bool reads_;
        } client(is_read);
        JobScenes scenes([](int number) {
            SceneDesc scene = scene_of(number);
            scene.water.scattering->b = {2, 2, 2};
            return scene;
        });
        RunEngine engine;
        engine.run({scenes, images_of_scenes({3, 1})}, client);
        ASSERT_EQ(client.notes.size(), 2U);
        EXPECT_EQ(!client.notes[0].empty(), is_read) << client.notes[0];
        EXPECT_EQ(client.notes[1], "");
    }
}

TEST(RunEngine, GivesEachWarningOnceInARun) {
    JobScenes scenes(scene_of);
    scenes.warn("of the job");
    RunEngine engine;
    for (int run = 0; run < 2; ++run) {
        Recorder client;
        engine.run({scenes, images_of_scenes({1, 2})}, client);
        EXPECT_EQ(client.warnings, (std::vector<std::string>{"0: the same", "0: scene 1",
                                                             "0: of the job", "1: scene 2"}));
    }
}

TEST(RunEngine, PassesOnAFaultOfWriting) {
    JobScenes scenes(scene_of);
    Recorder client;
    client.write = [](std::size_t place) {
        if (place == 1) throw IoError("full");
    };
    RunEngine engine;
    EXPECT_THROW(engine.run({scenes, images_of_scenes({1, 2, 3, 4})}, client), IoError);
    EXPECT_EQ(engine.written(), 1U);
    EXPECT_LT(client.films.size(), 4U);
}

TEST(RunEngine, WritesWhatWasRenderedBeforeAFault) {
    JobScenes scenes([](int number) -> SceneDesc {
        if (number == 3) throw InputError("no scene");
        return scene_of(number);
    });
    Recorder client;
    RunEngine engine;
    EXPECT_THROW(engine.run({scenes, images_of_scenes({1, 2, 3})}, client), InputError);
    EXPECT_EQ(engine.written(), 2U);
    EXPECT_LT(place_of(client, "written 1"), client.told.size());
}

TEST(RunEngine, StopsAsItsClientSays) {
    JobScenes scenes(scene_of);
    Recorder client;
    client.stop_after = 2;
    const StopScope scope(client.stop);
    RunEngine engine;
    EXPECT_THROW(engine.run({scenes, images_of_scenes({1, 2, 3})}, client), Interrupted);
    EXPECT_EQ(engine.written(), 2U);
    client.stop_after = 100;  // it stays usable
    client.stop = false;
    engine.run({scenes, images_of_scenes({1})}, client);
    EXPECT_EQ(engine.written(), 1U);
}

}  // namespace
}  // namespace uw::test
