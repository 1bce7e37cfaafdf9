// ctest labels: unit
// OpenColorIO configs of strangers: the library's recursion has no end where a part refers to
// itself, and it waits for pipes and reads devices. All of that is refused before it begins.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

const std::string k_identity = "!<MatrixTransform> {offset: [0, 0, 0, 0]}";

std::string space(const std::string& name, const std::string& from_reference,
                  const std::string& to_reference = "") {
    std::string text = "  - !<ColorSpace>\n    name: " + name + "\n";
    if (!from_reference.empty()) text += "    from_reference: " + from_reference + "\n";
    if (!to_reference.empty()) text += "    to_reference: " + to_reference + "\n";
    return text;
}

std::string from_to(const std::string& from, const std::string& to) {
    return "!<ColorSpaceTransform> {src: " + from + ", dst: " + to + "}";
}

class ColourConfigs : public test::CliTest {
  protected:
    /// A config whose view shows the space `out` through `looks`.
    std::string config(const std::string& spaces, const std::string& looks = "",
                       const std::string& more = "") const {
        return "ocio_profile_version: 2\nroles: {default: lin, scene_linear: lin}\n"
               "file_rules:\n  - !<Rule> {name: Default, colorspace: default}\ndisplays:\n  s:\n"
               "    - !<View> {name: V, colorspace: out" +
               (looks.empty() ? "" : ", looks: " + looks) + "}\n" + more +
               "colorspaces:\n  - !<ColorSpace> {name: lin}\n" + spaces;
    }
    test::ProgramResult render(const std::string& text,
                               const std::vector<std::string>& more = {}) const {
        if (!text.empty()) write("c.ocio", text);
        std::filesystem::remove(folder_ / "out.exr");
        std::vector<std::string> arguments{
            "render",    "scene.yaml", "-o",    "out.exr",
            "--quality", "draft",      "--set", "render.view={config: c.ocio}"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::run_program(arguments, {.folder = folder_.path(), .timeout_seconds = 60});
    }
    void expect_refused(const std::string& text, int exit_code, const std::string& part,
                        const std::vector<std::string>& more = {}) const {
        const test::ProgramResult result = render(text, more);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        EXPECT_EQ(test::line_count(result.err), 1) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    }
    void expect_shown(const std::string& text) const {
        const test::ProgramResult result = render(text);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(exists("out.png"));
    }
};

TEST_F(ColourConfigs, MayReferToOthersInChains) {
    expect_shown(config(space("out", k_identity)));
    std::string chain = space("out", from_to("lin", "s0"));
    for (int i = 0; i < 40; ++i)
        chain += space("s" + std::to_string(i), from_to("lin", "s" + std::to_string(i + 1)));
    expect_shown(config(chain + space("s40", k_identity)));
}

TEST_F(ColourConfigs, DoNotReferToThemselves) {
    const std::string own = "refers to itself";
    expect_refused(config(space("out", from_to("lin", "out"))), 3, own);
    expect_refused(config(space("out", "", from_to("out", "lin"))), 3, own);
    // By a role, by an alias, in a group, and undone.
    expect_refused(
        config(space("out", from_to("lin", "again")), "", "environment: {}\n") +
            space("again", "!<GroupTransform> {children: [" + from_to("lin", "out") + "]}"),
        3, own);
    expect_refused(config("  - !<ColorSpace>\n    name: out\n    aliases: [it]\n"
                          "    from_reference: " +
                          from_to("lin", "it") + "\n"),
                   3, own);
    expect_refused(config(space("out",
                                "!<ColorSpaceTransform> {src: out, dst: lin, direction: "
                                "inverse}")),
                   3, own);
    // Two, and three by way of a look, a view, and a named transform.
    expect_refused(config(space("out", from_to("lin", "b")) + space("b", from_to("lin", "out"))), 3,
                   "colour space 'out' -> colour space 'b' -> colour space 'out'");
    // Neither way leads to itself, but OpenColorIO, which looks for variables in both, would.
    expect_refused(config(space("out", from_to("lin", "b"), k_identity) +
                          space("b", k_identity, from_to("out", "lin"))),
                   3, own);
    expect_refused(config(space("out", "!<LookTransform> {src: lin, dst: lin, looks: +l}") +
                              space("b", from_to("lin", "out")),
                          "l",
                          "looks:\n  - !<Look> {name: l, process_space: lin, transform: " +
                              from_to("lin", "b") + "}\n"),
                   3, own);
    expect_refused(config(space("out", "!<DisplayViewTransform> {src: lin, display: s, view: V}")),
                   3, own);
    expect_refused(config(space("out", k_identity), "l",
                          "looks:\n  - !<Look> {name: l, process_space: lin, transform: "
                          "!<DisplayViewTransform> {src: lin, display: s, view: V}}\n"),
                   3, own);
    expect_refused(config(space("out", from_to("lin", "n"))) +
                       "named_transforms:\n  - !<NamedTransform> {name: n, transform: " +
                       from_to("lin", "out") + "}\n",
                   3, own);
}

TEST_F(ColourConfigs, AreNeitherDeepNorEndless) {
    std::string chain = space("out", from_to("lin", "s0"));
    for (int i = 0; i < 1000; ++i)
        chain += space("s" + std::to_string(i), from_to("lin", "s" + std::to_string(i + 1)));
    expect_refused(config(chain + space("s1000", k_identity)), 3, "chain of more than 100");
    // The other way round each part is known before what refers to it is met.
    std::string backwards = space("t0", k_identity);
    for (int i = 0; i < 200; ++i)
        backwards += space("t" + std::to_string(i + 1), from_to("lin", "t" + std::to_string(i)));
    expect_refused(config(backwards + space("out", from_to("lin", "t200"))), 3,
                   "chain of more than 100");
    std::string doubled = space("out", from_to("lin", "d0"));
    for (int i = 0; i < 40; ++i) {
        const std::string next = from_to("lin", "d" + std::to_string(i + 1));
        doubled += space("d" + std::to_string(i),
                         "!<GroupTransform> {children: [" + next + ", " + next + "]}");
    }
    expect_refused(config(doubled + space("d40", k_identity)), 3, "more than 1000 steps");
    // The same as text, before OpenColorIO reads it.
    std::string aliases = "ocio_profile_version: 2\na0: &a0 [x, x]\n";
    for (int i = 0; i < 40; ++i) {
        const std::string was = "*a" + std::to_string(i);
        aliases += "a" + std::to_string(i + 1) + ": &a" + std::to_string(i + 1) + " [" + was +
                   ", " + was + "]\n";
    }
    expect_refused(aliases, 3, "this is not a valid OpenColorIO config");
    expect_refused("ocio_profile_version: " + std::string(100000, '['), 3,
                   "this is not a valid OpenColorIO config");
}

TEST_F(ColourConfigs, ReadNoPipesNorDevices) {
    const std::string table =
        config(space("out", "!<FileTransform> {src: luts/t.spi1d, interpolation: linear}"));
    std::filesystem::create_directories(folder_ / "luts");
    const std::filesystem::path file = folder_ / "luts/t.spi1d";
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    expect_refused(table, 4, "is a pipe");
    std::filesystem::remove(file);
    std::filesystem::create_symlink("/dev/zero", file);
    expect_refused(table, 4, "is a device");
    std::filesystem::remove(file);
    std::filesystem::create_directories(file);
    expect_refused(table, 4, "is a folder");
    std::filesystem::remove(file);
    write("luts/t.spi1d", "Version 1\nFrom 0.0 1.0\nLength 2\nComponents 1\n{\n0\n1\n}\n");
    expect_shown(table);
    std::filesystem::remove(folder_ / "c.ocio");
    ASSERT_EQ(::mkfifo((folder_ / "c.ocio").c_str(), 0600), 0);
    expect_refused("", 3, "pipe or device");
}

TEST_F(ColourConfigs, KeepWhatTablesReferToWhereItIsConfined) {
    const std::string table =
        config(space("out", "!<FileTransform> {src: t.ctf, interpolation: linear}"));
    const std::string head = "<ProcessList id=\"a\" version=\"2\">";
    const std::string matrix =
        "<Matrix inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"3 3\">1 0 0 0 1 0 0 0 1"
        "</Array></Matrix></ProcessList>\n";
    write("t.ctf", "<?xml version=\"1.0\"?>\n" + head + matrix);
    expect_shown(table);
    const std::string reference =
        "<Reference path=\"/etc/passwd\" inBitDepth=\"32f\" outBitDepth=\"32f\"/></ProcessList>\n";
    write("t.ctf", "\n  " + head + reference);
    expect_refused(table, 3, "has a <Reference>");
    std::string wide = "\xff\xfe";
    for (const char c : head + reference) wide += std::string{c, '\0'};
    write("t.ctf", wide);
    expect_refused(table, 3, "has a <Reference>");
    write("t.ctf", "<!DOCTYPE a [<!ENTITY r \"&#60;Ref\">]>" + head + matrix);
    expect_refused(table, 3, "has a <!DOCTYPE>");
}

}  // namespace
}  // namespace uw
