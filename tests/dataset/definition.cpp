// ctest labels: unit
#include "dataset/definition.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace uw {
namespace {

DatasetDefinition some_set() {
    DatasetDefinition d;
    d.program = "uwvdb 1";
    d.scene = "scene.yaml";
    d.draws = {{"a=1"}, {"a=2"}, {"a=3"}};
    d.frames = {2, 3, 4, 7};
    d.cameras = {"left", "right"};
    d.formats = {"png", "depth"};
    d.depth_far = 12.5;
    d.pinhole_fit = true;
    d.licence = "CC0";
    return d;
}

TEST(DatasetDefinition, ViewsAndIndicesAreInverse) {
    const DatasetDefinition d = some_set();
    EXPECT_EQ(d.view_count(), 24U);
    for (std::size_t i = 0; i < d.view_count(); ++i) EXPECT_EQ(d.index(d.view(i)), i);
    EXPECT_EQ(d.file({2, 3, 1}, "depth", ".png"), "draw_00002/depth/right/000007.png");
    EXPECT_EQ(d.place_of_frame(4), 2U);
    EXPECT_EQ(d.place_of_frame(5), std::nullopt);
    DatasetDefinition one;
    EXPECT_EQ(one.file({}, "images", ".png"), "images/000000.png");
}

TEST(DatasetDefinition, ShardsCoverAllViewsOnceWithAllCamerasOfAFrame) {
    const DatasetDefinition d = some_set();
    for (std::size_t count = 1; count <= 30; ++count) {
        std::size_t next = 0;
        for (std::size_t number = 1; number <= count; ++number) {
            const ViewRange range = shard_of(d, number, count);
            EXPECT_EQ(range.begin, next);
            EXPECT_EQ(range.begin % 2, 0U);
            const std::size_t frames = (range.end - range.begin) / 2;
            EXPECT_LE(frames, (12 + count - 1) / count);
            EXPECT_GE(frames, 12 / count);
            next = range.end;
        }
        EXPECT_EQ(next, d.view_count());
    }
}

TEST(DatasetDefinition, IsItselfAfterJson) {
    for (const DatasetDefinition& d : {some_set(), DatasetDefinition{}})
        EXPECT_EQ(definition_from_json(Json::parse(definition_json(d).dump()), "x"), d);
    EXPECT_THROW(definition_from_json(Json::parse("{\"frames\": 3}"), "x"), InputError);
}

TEST(DatasetDefinition, SaysWhatDiffers) {
    const DatasetDefinition a = some_set();
    EXPECT_EQ(difference(a, a), "");
    DatasetDefinition b = a;
    b.command = "another spelling";
    EXPECT_EQ(difference(a, b), "");
    b.frames = {1};
    EXPECT_EQ(difference(a, b), "its frames are 2-4,7 there, 1 here");
    b = a;
    b.licence.clear();
    EXPECT_EQ(difference(a, b), "its licence is CC0 there, not given here");
}

}  // namespace
}  // namespace uw
