// ctest labels: unit
#include "core/scene/yaml_document.h"

#include <gtest/gtest.h>

#include <random>

#include "core/base/error.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

std::string document_error(std::string_view text) {
    try {
        parse_yaml(text, "s.yaml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no InputError";
}

void expect_error(std::string_view text, std::string_view expected) {
    const std::string found = document_error(text);
    EXPECT_NE(found.find(expected), std::string::npos)
        << "gave:     " << found << "\nexpected: " << expected;
    EXPECT_EQ(found.find('\n'), std::string::npos) << "one line";
}

std::string repeated(std::string_view unit, std::size_t count) {
    std::string text;
    text.reserve(unit.size() * count);
    for (std::size_t i = 0; i < count; ++i) text += unit;
    return text;
}

TEST(YamlDocument, keepsPlacesAndQuotes) {
    const ConfigNode root = parse_yaml("a: 1\nb:\n  - x\n  - 'y'\nc:\n", "s.yaml");
    ASSERT_EQ(root.entries.size(), 3U);
    EXPECT_EQ(root.entries[1].position.text(), "s.yaml:2:1");
    const ConfigNode& list = root.entries[1].value;
    ASSERT_EQ(list.items.size(), 2U);
    EXPECT_EQ(list.items[1].position.text(), "s.yaml:4:5");
    EXPECT_FALSE(list.items[0].quoted);
    EXPECT_TRUE(list.items[1].quoted);
    EXPECT_EQ(root.entries[2].value.kind, ConfigNode::Kind::null);
    EXPECT_EQ(root.entries[2].value.position.line, 5);
}

TEST(YamlDocument, refusesWhatIsNoSceneText) {
    expect_error("", "s.yaml:1:1: is empty");
    expect_error("# only a comment\n", "s.yaml:1:1: is empty");
    expect_error("~\n", "s.yaml:1:1: is empty");
    expect_error(std::string_view("a: 1\n\0b: 2\n", 11), "s.yaml:2:1: not UTF-8 text (byte 5)");
    expect_error("a: \xff\xfe\n", "not UTF-8 text");
    expect_error("a: caf\xe9\n", "not UTF-8 text");
    expect_error("a: \xc0\xaf\n", "not UTF-8 text");
    expect_error("a: \xed\xa0\x80\n", "not UTF-8 text");
    EXPECT_NO_THROW(
        parse_yaml("\xef\xbb\xbf"
                   "a: caf\xc3\xa9 \xf0\x9f\x90\x9f\n",
                   "s.yaml"));
}

TEST(YamlDocument, knowsOtherFormatsByTheirBytesOrElseTheirNames) {
    const auto error_of = [](std::string_view text, const std::string& name) {
        return test::message_of<InputError>([&] { parse_yaml(text, name); });
    };
    EXPECT_EQ(error_of(std::string_view(" BDV\0\0\0\0", 8), "a.yaml"),
              "a.yaml: is a VDB volume, not a valid scene; a scene that shows it is written by: "
              "uwvdb info 'a.yaml' --scene > scene.yaml");
    EXPECT_TRUE(error_of("\xff", "a.BLEND").starts_with("a.BLEND: is a Blender file"));
    EXPECT_TRUE(error_of("\xff", "a").starts_with("a:1:1: not UTF-8 text"));
    EXPECT_TRUE(error_of("{}", "a.gltf").starts_with("a.gltf: is a glTF file"));
    EXPECT_NO_THROW(parse_yaml("a: 1\n", "a.vdb"));  // text is read, whatever its name
    EXPECT_NO_THROW(parse_yaml_value("a.gltf", "--set geometry[0].file=a.gltf"));
}

TEST(YamlDocument, saysWhereATabIndents) {
    const std::string what = ": a tab indents this line, but YAML takes none there";
    expect_error("a: 1\nb:\n\tc: [2, 2]\n", "s.yaml:3:1" + what);
    expect_error("b:\n  c: 1\n \td: 2\n", "s.yaml:3:2" + what);
    expect_error("b:\n\t- name: a\n\t  x: 1\n", "s.yaml:2:1" + what);
    // Within brackets and behind values tabs are allowed: the fault is another.
    expect_error("a: {\n\tb: 1,\n\tc: [1,\n\t2\n}\n", "s.yaml:5:1: illegal flow end");
    expect_error("a: [1,\n\t2]\nb: c: d\n", "s.yaml:3:5: illegal map value");
    EXPECT_NO_THROW(parse_yaml("a: {\n\tb: 1\n}\t# comment\n", "s.yaml"));
}

TEST(YamlDocument, refusesWhatHasNoOneMeaning) {
    expect_error("a: 1\n---\nb: 2\n", "s.yaml:2:1: a second document starts here");
    expect_error("a: 1\n---\n# why\n\nb: 2\n", "a second document starts here");
    // Nothing marks a document where words are no keys.
    expect_error("some words\n\n#pinax\nand 0.5\n",
                 "s.yaml:4:1: what is above is complete, and this is no part of it");
    expect_error("---\nsome words\n# more\nand 0.5\n", "what is above is complete");
    expect_error("a: {b: 1,\n  b: 2}\n",
                 "s.yaml:2:3: a.b: the key is given twice (first on line 1); remove one");
    expect_error("x:\n - {k: 1, k: 2}\n", "s.yaml:2:11: x[0].k: the key is given twice");
    expect_error("[1, 2]: 3\n", "s.yaml:1:1: a key must be a word, found a list of 2");
    expect_error("a: !!float 3\n", "the tag 'tag:yaml.org,2002:float' has no meaning");
    expect_error("a: *none\n", "s.yaml:1:4: the referenced anchor is not defined");
    expect_error("a: &x [*x]\n", "s.yaml:1:8: an alias inside the value it refers to");
}

TEST(YamlDocument, aliasesHaveThePlaceOfTheirValueAndTheirOwn) {
    const ConfigNode root = parse_yaml("a: &x {b: 1}\nc: [*x]\n", "s.yaml");
    const ConfigNode& written = *root.find("a");
    const ConfigNode& copy = root.find("c")->items[0];
    EXPECT_EQ(written.position.text(), "s.yaml:1:4");
    EXPECT_EQ(written.alias.line, 0);
    EXPECT_EQ(copy.position.text(), "s.yaml:1:4");
    EXPECT_EQ(copy.alias.text(), "s.yaml:2:5");
    EXPECT_EQ(copy.find("b")->alias.line, 0);
}

TEST(YamlDocument, syntaxErrorsHaveAPlace) {
    expect_error("a: [1, 2\nb: 3\n", "s.yaml:2:2: ");
    expect_error("a: - 1\n", "s.yaml:1:4: ");
    expect_error("a: b: c\n", "s.yaml:1:5: illegal map value; correct the YAML here");
    for (const char* const open : {"a: 'x\nb: 1\n", "a: 'x", "a: \"x\nb: 1\n", "{a: &b 'x\n}"}) {
        expect_error(open, "text above this line has an opening quote but no closing one");
    }
}

TEST(YamlDocument, deepNestingEndsAtTheLimit) {
    expect_error(repeated("[", 100000), "nested more than 64 deep");
    expect_error(repeated("{a: ", 100000), "nested more than 64 deep");
    expect_error(repeated("- ", 100000), "nested more than 64 deep");
    expect_error(repeated("? ", 100000), "nested more than 64 deep");
    EXPECT_NO_THROW(parse_yaml(repeated("[", 60) + repeated("]", 60), "s.yaml"));
}

TEST(YamlDocument, aliasesCannotGrowWithoutBound) {
    std::string laughs = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
    for (int i = 1; i < 12; ++i) {
        const std::string name = "*a" + std::to_string(i - 1);
        laughs += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + name;
        for (int k = 1; k < 10; ++k) laughs += ", " + name;
        laughs += "]\n";
    }
    expect_error(laughs, "more than 200000 values");
    // few nodes, but each copy is large
    expect_error("t: &t " + repeated("x", 1000000) + "\nl: [" + repeated("*t, ", 1000) + "1]\n",
                 "more than 200000 values");
    // anchors around anchors are stored once each
    std::string nested = "r: ";
    for (int i = 0; i < 60; ++i) nested += "&n" + std::to_string(i) + " [";
    nested += repeated("1,", 50000) + repeated("]", 60) + "\n";
    expect_error(nested, "more than 200000 values");
}

TEST(YamlDocument, hugeFilesAreTurnedAwayUnparsed) {
    expect_error(repeated("# padding\n", (std::size_t{16} << 20U) / 10 + 1),
                 "s.yaml:1:1: larger than 16777216 bytes");
    expect_error("a: " + repeated("[", 2000000), "more than 1000000 brackets");
    expect_error(repeated("- 1\n", 300000), "more than 200000 values");
}

TEST(YamlDocument, randomTextNeverDoesWorseThanAnInputError) {
    std::mt19937 random(1);  // NOLINT(bugprone-random-generator-seed): the same texts each time
    constexpr std::string_view k_alphabet = "ab1:- \n[]{},&*!'\"|>%#?~\\\t.x";
    std::uniform_int_distribution<std::size_t> letter(0, k_alphabet.size() - 1);
    std::uniform_int_distribution<std::size_t> length(1, 60);
    for (int i = 0; i < 20000; ++i) {
        std::string text(length(random), ' ');
        for (char& c : text) c = k_alphabet[letter(random)];
        try {
            parse_yaml(text, "s.yaml");
        } catch (const InputError& error) {
            EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << text;
        }
    }
}

TEST(YamlDocument, valuesMayBeNothing) {
    EXPECT_EQ(parse_yaml_value("", "--set a=").kind, ConfigNode::Kind::null);
    const ConfigNode value = parse_yaml_value("{x: [1]}", "--set a={x: [1]}");
    EXPECT_EQ(value.find("x")->items.at(0).position.text(), "--set a={x: [1]}");
}

}  // namespace
}  // namespace uw
