// ctest labels: unit
#include "edit/document/scene_document.h"

#include <gtest/gtest.h>

#include <chrono>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/output_files.h"
#include "tests/support/file_bytes.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

namespace fs = std::filesystem;

constexpr auto k_scene =
    "# a scene\nuwvdb: 1\ncamera: {resolution: [64, 48], intrinsics: {fov_x: 60}}\n"
    "render: {samples: 1}  # one\n";

class Documents : public testing::Test {
  protected:
    Documents() : file_(folder_.write("scene.yaml", k_scene)) {}

    static void set_samples(SceneDocument& document, const std::string& samples) {
        SceneText next = document.scene();
        next.set("render.samples", samples);
        document.record(std::move(next), "samples " + samples);
    }
    static std::string with_samples(const std::string& samples) {
        std::string text = k_scene;
        return text.replace(text.find("samples: 1") + 9, 1, samples);
    }
    /// As another program would, with another date.
    void write_elsewhere(const std::string& text) const {
        folder_.write("scene.yaml", text);
        fs::last_write_time(file_, fs::last_write_time(file_) + std::chrono::seconds(2));
    }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
    }

    SceneFolder folder_;
    fs::path file_;
};

TEST_F(Documents, SaveTheirTextAndKeepTheFilesPermissions) {
    fs::permissions(file_, fs::perms::owner_read | fs::perms::owner_write);
    SceneDocument document(file_);
    EXPECT_FALSE(document.is_unsaved());
    set_samples(document, "3");
    EXPECT_TRUE(document.is_unsaved());
    EXPECT_EQ(file_bytes(file_), k_scene);
    document.save();
    EXPECT_FALSE(document.is_unsaved());
    EXPECT_EQ(file_bytes(file_), with_samples("3"));
    EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(document.disk_state(), DiskState::same);
    EXPECT_EQ(files(), 1U);
    document.undo();
    EXPECT_TRUE(document.is_unsaved());
    EXPECT_EQ(document.scene().text(), k_scene);
    EXPECT_EQ(document.scene().find("render.samples")->scalar, "1");
    document.redo();
    EXPECT_FALSE(document.is_unsaved());
}

// The rule that outputs never replace inputs holds for all but the document itself, before and
// after it was saved.
TEST_F(Documents, AreTheOnlyInputsThatMayBeReplaced) {
    const fs::path table = folder_.write("table.csv", "x");
    remember_input(table);
    SceneDocument document(file_);
    set_samples(document, "3");
    EXPECT_THROW(AtomicFile{file_}, IoError);
    document.save();
    EXPECT_THROW(AtomicFile{file_}, IoError);
    EXPECT_NE(message_of<IoError>([&] {
                  document.save_as(table, Overwrite::yes);
              }).find("a file that this run reads"),
              std::string::npos);
    EXPECT_EQ(file_bytes(table), "x");
    EXPECT_EQ(document.file(), file_);
}

TEST_F(Documents, AreWrittenThroughALink) {
    const fs::path link = folder_.path() / "link.yaml";
    fs::create_symlink("scene.yaml", link);
    SceneDocument document(link);
    set_samples(document, "3");
    document.save();
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(file_bytes(file_), with_samples("3"));
    EXPECT_EQ(document.disk_state(), DiskState::same);
}

TEST_F(Documents, NoticeChangesByOtherPrograms) {
    SceneDocument document(file_);
    set_samples(document, "3");
    write_elsewhere(k_scene);
    EXPECT_EQ(document.disk_state(), DiskState::same) << "touched only";
    write_elsewhere(with_samples("9"));
    EXPECT_EQ(document.disk_state(), DiskState::changed);
    EXPECT_NE(
        message_of<ConflictError>([&] { document.save(); }).find("changed by another program"),
        std::string::npos);
    EXPECT_EQ(file_bytes(file_), with_samples("9"));
    document.reload();
    EXPECT_EQ(document.scene().text(), with_samples("9"));
    EXPECT_FALSE(document.is_unsaved());
    document.undo();
    EXPECT_EQ(document.scene().text(), with_samples("3")) << "what was not saved is not lost";
    write_elsewhere(with_samples("8"));
    document.save(Overwrite::yes);
    EXPECT_EQ(file_bytes(file_), with_samples("3"));
    fs::remove(file_);
    EXPECT_EQ(document.disk_state(), DiskState::missing);
    document.save();
    EXPECT_EQ(file_bytes(file_), with_samples("3"));
}

TEST_F(Documents, StayAsTheyAreWhenTheFileIsBroken) {
    SceneDocument document(file_);
    write_elsewhere("uwvdb: [1\n");
    EXPECT_NE(message_of<InputError>([&] { document.reload(); }).find("scene.yaml:"),
              std::string::npos);
    EXPECT_EQ(document.scene().text(), k_scene);
    EXPECT_EQ(document.disk_state(), DiskState::changed);
    write_elsewhere(with_samples("5"));
    document.reload();
    EXPECT_EQ(document.scene().text(), with_samples("5"));
}

TEST_F(Documents, AreSavedUnderAnotherNameInTheirFolder) {
    SceneDocument document(file_);
    set_samples(document, "3");
    const fs::path other = folder_.path() / "other.yaml";
    document.save_as(other);
    EXPECT_EQ(file_bytes(other), with_samples("3"));
    EXPECT_EQ(file_bytes(file_), k_scene);
    EXPECT_EQ(document.file(), other);
    EXPECT_EQ(document.scene().origin(), other.string());
    EXPECT_FALSE(document.is_unsaved());
    EXPECT_NE(message_of<IoError>([&] {
                  document.save_as(folder_.path() / "sub/x.yaml");
              }).find("own folder"),
              std::string::npos);
    const fs::path there = folder_.write("there.yaml", "x");
    EXPECT_NE(message_of<ConflictError>([&] { document.save_as(there); }).find("exists"),
              std::string::npos);
    EXPECT_EQ(file_bytes(there), "x");
    document.save_as(there, Overwrite::yes);
    EXPECT_EQ(file_bytes(there), with_samples("3"));
    EXPECT_EQ(files(), 3U);
}

}  // namespace
}  // namespace uw::test
