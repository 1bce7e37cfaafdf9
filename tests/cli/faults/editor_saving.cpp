// ctest labels: unit
// What the editor does if its saving fails: calls to the system as in failing_calls.cpp.
#include <gtest/gtest.h>
#include <httplib.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "tests/support/edit_scene.h"
#include "tests/support/run_program.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

class EditorSaving : public testing::TestWithParam<const char*> {
  protected:
    /// An editor of which the n-th call of the kind fails.
    struct Editor {
        Editor(const std::string& scene, const std::string& fault, const std::string& done) {
            ::setenv("LD_PRELOAD", UWVDB_FAILING_CALLS, 1);
            ::setenv("UWVDB_FAIL", fault.c_str(), 1);
            ::setenv("UWVDB_FAIL_DONE", done.c_str(), 1);
            program =
                std::make_unique<Program>(std::vector<std::string>{"edit", scene, "--no-browser"});
            for (const char* name : {"LD_PRELOAD", "UWVDB_FAIL", "UWVDB_FAIL_DONE"})
                ::unsetenv(name);
            EXPECT_TRUE(eventually([&] { return program->output().ends_with("/\n"); }));
            // http://127.0.0.1:PORT/TOKEN/
            const std::string address = program->output();
            const std::size_t slash = address.find('/', 17);
            root = address.substr(slash, address.size() - slash - 2);
            client = std::make_unique<httplib::Client>("127.0.0.1",
                                                       std::stoi(address.substr(17, slash - 17)));
            client->set_read_timeout(300);
        }
        httplib::Result post(const std::string& address, const Json& body) {
            httplib::Result answer = client->Post(root + address, body.dump(), "application/json");
            EXPECT_TRUE(answer) << address;
            return answer;
        }
        std::unique_ptr<Program> program;
        std::unique_ptr<httplib::Client> client;
        std::string root;
    };

    static std::string text_of(const std::filesystem::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

TEST_P(EditorSaving, LosesNothingAndSavesAgain) {
    constexpr int k_most = 100;
    int n = 0;
    bool has_failed = true;
    for (n = 1; has_failed && n <= k_most; ++n) {
        SCOPED_TRACE(n);
        const SceneFolder folder, elsewhere;
        const std::filesystem::path scene = folder.write("rig.yaml", k_edit_scene);
        const std::filesystem::path done = elsewhere.path() / "done";
        Editor editor(scene.string(), std::string(GetParam()) + ":" + std::to_string(n),
                      done.string());
        const auto state = editor.client->Get(editor.root + "/api/state");
        ASSERT_TRUE(state);
        const Json change{{"op", "set"}, {"path", "lamps.left.position"}, {"value", {0, 1, 1}}};
        const auto moved = editor.post(
            "/api/edit",
            {{"revision", Json::parse(state->body)["revision"]}, {"changes", {change}}});
        ASSERT_EQ(moved->status, 200) << moved->body;
        const auto saved = editor.post("/api/save", Json::object());
        const std::string now = text_of(scene);
        if (saved->status == 200) {
            EXPECT_NE(now.find("position: [0, 1, 1]"), std::string::npos) << now;
        } else {
            EXPECT_EQ(saved->status, 422) << saved->body;
            EXPECT_EQ(now, k_edit_scene);
            EXPECT_NE(saved->body.find("rig.yaml: cannot write: "), std::string::npos)
                << saved->body;
            const auto after = editor.client->Get(editor.root + "/api/state");
            ASSERT_TRUE(after);
            EXPECT_EQ(Json::parse(after->body)["unsaved"], true);
            EXPECT_EQ(editor.post("/api/save", Json::object())->status, 200);
            EXPECT_NE(text_of(scene).find("position: [0, 1, 1]"), std::string::npos);
        }
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
        has_failed = std::filesystem::exists(done);
        editor.program->signal(SIGINT);
        const ProgramResult result = editor.program->wait();
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
    }
    EXPECT_GT(n, 2) << "no call failed";
    EXPECT_LE(n, k_most);
}

INSTANTIATE_TEST_SUITE_P(Calls, EditorSaving, testing::Values("open", "write", "rename", "fsync"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace uw::test
