// ctest labels: unit threads
#include <gtest/gtest.h>

#include <csignal>
#include <string>

#include "tests/support/edit_scene.h"
#include "tests/support/run_program.h"
#include "tests/support/scene_folder.h"

namespace {

using namespace uw::test;

TEST(EditCommand, ServesUntilItIsStopped) {
    const SceneFolder folder;
    const std::string scene = folder.write("rig.yaml", k_edit_scene).string();
    for (const int signal : {SIGINT, SIGTERM}) {
        Program program({"edit", scene, "--no-browser"});
        EXPECT_TRUE(eventually([&] { return !program.output().empty(); }));
        program.signal(signal);
        const ProgramResult result = program.wait();
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        EXPECT_EQ(line_count(result.out), 1);
        EXPECT_TRUE(result.out.starts_with("http://127.0.0.1:")) << result.out;
    }
}

TEST(EditCommand, WhatIsWrongIsOneLine) {
    const SceneFolder folder;
    const ProgramResult missing = run_program({"edit", "none.yaml", "--no-browser"});
    EXPECT_EQ(missing.exit_code, 4);
    EXPECT_EQ(missing.err, "uwvdb: none.yaml: no such file; check the name of the scene\n");
    EXPECT_EQ(run_program({"edit"}).exit_code, 2);
    EXPECT_EQ(run_program({"edit", "x.yaml", "--port", "70000"}).exit_code, 2);
    const std::string scene = folder.write("rig.yaml", k_edit_scene).string();
    // Ports below 1024 are the system's where we are not root; 1 is taken by nobody.
    Program first({"edit", scene, "--no-browser"});
    ASSERT_TRUE(eventually([&] { return first.output().ends_with("/\n"); }));
    const std::string address = first.output();
    const std::string port = address.substr(17, address.find('/', 17) - 17);
    const ProgramResult taken = run_program({"edit", scene, "--no-browser", "--port", port});
    EXPECT_EQ(taken.exit_code, 4);
    EXPECT_EQ(line_count(taken.err), 1) << taken.err;
    EXPECT_NE(taken.err.find("port " + port), std::string::npos) << taken.err;
    first.signal(SIGINT);
    first.wait();
}

}  // namespace
