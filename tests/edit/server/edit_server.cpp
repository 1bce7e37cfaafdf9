// ctest labels: unit threads
#include "edit/server/edit_server.h"

#include <gtest/gtest.h>
#include <httplib.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/base/json.h"
#include "tests/support/edit_scene.h"
#include "tests/support/scene_folder.h"

namespace {

using namespace uw;
using namespace uw::test;

class EditServerTest : public testing::Test {
  protected:
    EditServerTest() {
        client_.set_keep_alive(true);
        client_.set_read_timeout(300);  // 5 s are few for a sanitizer on a busy machine
    }

    std::string path(const std::string& rest) const { return "/" + server_.token() + rest; }
    Json get(const std::string& address, int status = 200) {
        const auto answer = client_.Get(path(address));
        EXPECT_TRUE(answer);
        EXPECT_EQ(answer->status, status) << answer->body;
        return Json::parse(answer->body);
    }
    Json post(const std::string& address, const Json& body, int status = 200) {
        const auto answer = client_.Post(path(address), body.dump(), "application/json");
        EXPECT_TRUE(answer);
        EXPECT_EQ(answer->status, status) << answer->body;
        return Json::parse(answer->body);
    }
    Json edit(const Json& change, int status = 200) {
        return post("/api/edit",
                    {{"revision", get("/api/state")["revision"]}, {"changes", {change}}}, status);
    }

    /// The state once nothing changes it but requests: the outlines come with the first picture,
    /// and after it the note on the light that the picture leaves out.
    Json whole_state() {
        EXPECT_TRUE(eventually([&] {
            const Json state = get("/api/state");
            return !state["light_note"].is_null() && state["outlines"]["count"] != 0;
        }));
        return get("/api/state");
    }

    SceneFolder folder_;
    std::filesystem::path file_ = folder_.write("rig.yaml", k_edit_scene);
    EditSession session_{file_};
    EditServer server_{session_, 0};
    httplib::Client client_{"127.0.0.1", server_.port()};
};

TEST_F(EditServerTest, ServesThePage) {
    const auto page = client_.Get(path("/"));
    ASSERT_TRUE(page);
    EXPECT_EQ(page->status, 200);
    EXPECT_EQ(page->get_header_value("Content-Type"), "text/html; charset=utf-8");
    EXPECT_TRUE(
        page->get_header_value("Content-Security-Policy").starts_with("default-src 'self'"));
    EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
    EXPECT_FALSE(page->has_header("Access-Control-Allow-Origin"));
    EXPECT_EQ(client_.Get(path("/page/index.html"))->body, page->body);
    EXPECT_EQ(server_.token().size(), 32U);
}

TEST_F(EditServerTest, EditsUndoesAndSaves) {
    const Json moved = edit({{"op", "set"}, {"path", "lamps.left.position"}, {"value", {0, 1, 1}}});
    EXPECT_EQ(moved["lamps"][0]["position"], Json::parse("[0.0,1.0,1.0]"));
    EXPECT_EQ(moved["unsaved"], true);
    EXPECT_EQ(post("/api/undo", Json::object())["unsaved"], false);
    EXPECT_EQ(post("/api/redo", Json::object())["unsaved"], true);
    EXPECT_EQ(post("/api/save", Json::object())["unsaved"], false);
    EXPECT_EQ(post("/api/save_as", {{"file", "b.yaml"}})["scene"], "b.yaml");
    EXPECT_EQ(post("/api/reload", Json::object())["scene"], "b.yaml");
}

/// All addresses below the token that are asked for by one method.
const std::vector<std::string> k_gets{"/",
                                      "/api/state",
                                      "/api/outlines",
                                      "/api/events",
                                      "/api/image",
                                      "/api/numbers",
                                      "/api/view",
                                      "/api/export/numbers.csv",
                                      "/api/export/picture.png",
                                      "/page/index.html"};
const std::vector<std::string> k_posts{"/api/edit",    "/api/undo",    "/api/redo",
                                       "/api/show",    "/api/reload",  "/api/save",
                                       "/api/save_as", "/api/suggest", "/api/suggest/cancel"};

/// What no request may be, whatever it asks for.
TEST_F(EditServerTest, EveryAddressRefusesWhatIsNoRequestToIt) {
    const Json before = whole_state();
    for (const std::string& address : k_gets) {
        post(address, Json::object(), 405);
        EXPECT_EQ(client_.Put(path(address), "x", "text/plain")->status, 405) << address;
        EXPECT_EQ(client_.Delete(path(address))->status, 405) << address;
        EXPECT_EQ(client_.Options(path(address))->status, 405) << address;
        EXPECT_EQ(client_.Head(path(address))->status, 405) << address;
    }
    for (const std::string& address : k_posts) {
        SCOPED_TRACE(address);
        const auto raw = [&](const std::string& body, const char* type = "application/json") {
            return client_.Post(path(address), body, type)->status;
        };
        get(address, 405);
        EXPECT_EQ(client_.Put(path(address), "{}", "application/json")->status, 405);
        for (const std::string& body :
             {std::string("{"), std::string("[]"), std::string("null"), std::string("1e999"),
              std::string("\"x\""), std::string("\xff\xfe"), std::string("{\"a\": 1e999}"),
              std::string("{\"a\": NaN}"), std::string("{\"a\": 1,}"), std::string("{} {}"),
              std::string("{\"a\": \"\xff\"}"), std::string("\0", 1), std::string(100000, '['),
              "{\"a\": " + std::string(50, '[') + std::string(50, ']') + "}"})
            EXPECT_EQ(raw(body), 400) << body.substr(0, 40);
        EXPECT_EQ(raw("{}", "text/plain"), 415);
        EXPECT_EQ(raw("a=b", "application/x-www-form-urlencoded"), 415);
        EXPECT_EQ(raw(std::string(256 * 1024 + 1, ' ')), 413);
    }
    // Ranges are not cut out; what is no range is refused.
    for (const char* range : {"bytes=0-10", "bytes=-5", "bytes=0-1,3-4", "bytes=99999999999-"}) {
        const auto whole = client_.Get(path("/page/index.html"), {{"Range", range}});
        ASSERT_TRUE(whole) << range;
        EXPECT_EQ(whole->status, 200) << range;
        EXPECT_EQ(whole->body, client_.Get(path("/page/index.html"))->body) << range;
    }
    EXPECT_EQ(client_.Get(path("/page/index.html"), {{"Range", "lines=1-2"}})->status, 416);
    for (const char* address : {"/api/none", "/api", "/api/", "/page/none.js", "/api/state/"})
        get(address, 404);
    post("/api/none", Json::object(), 404);
    EXPECT_EQ(get("/api/state"), before);
}

/// What each request may hold that is wrong, and what the scene refuses.
TEST_F(EditServerTest, EveryFailureHasItsCodeAndChangesNothing) {
    const Json before = whole_state();
    EXPECT_NE(edit({{"op", "set"}, {"path", "water.preset"}, {"value", "puddle"}}, 422)["error"]
                  .get<std::string>()
                  .find("unknown value 'puddle'"),
              std::string::npos);
    const auto set = [](const char* key, const Json& value) {
        return Json{{"op", "set"}, {"path", key}, {"value", value}};
    };
    // Numbers and paths that no scene can have.
    for (const Json& value : {Json(1e308), Json(-1), Json("x"), Json::array({1, 2}), Json(1e-320),
                              Json::object(), Json(std::numeric_limits<std::uint64_t>::max())})
        edit(set("camera.intrinsics.fov_x", value), 422);
    for (const char* key : {"lamps.nobody.position", "lamps[99].position", "no.such.key"})
        edit(set(key, 1), 422);
    for (const char* key : {"", ".", "lamps[-1]", "water..preset", "lamps[18446744073709551616]"})
        edit(set(key, 1), 400);
    for (const Json& change :
         {Json{{"op", "explode"}},
          Json{{"op", 1}},
          Json::object(),
          Json("set"),
          Json(nullptr),
          Json{{"op", "set"}},
          Json{{"op", "set"}, {"path", "a"}},
          Json{{"op", "set"}, {"value", 1}},
          Json{{"op", "set"}, {"path", 1}, {"value", 1}},
          Json{{"op", "add_lamp"}},
          Json{{"op", "add_lamp"}, {"lamp", "x"}},
          Json{{"op", "remove_lamp"}, {"lamp", "nobody"}},
          Json{{"op", "remove_lamp"}, {"lamp", 0}},
          Json{{"op", "duplicate_lamp"}},
          Json{{"op", "mirror_lamp"}, {"lamp", "left"}, {"copy", 1}},
          Json{{"op", "rename_lamp"}, {"lamp", "left"}},
          Json{{"op", "move_lamp"}, {"lamp", "left"}},
          Json{{"op", "move_lamp"}, {"lamp", "left"}, {"pixel", {1}}},
          Json{{"op", "move_lamp"}, {"lamp", "left"}, {"pixel", {1, 2}}, {"keep", "pace"}},
          Json{{"op", "move_lamp"}, {"lamp", "left"}, {"world", {0, 0, "x"}}},
          Json{{"op", "aim_lamp"}, {"lamp", "left"}, {"pixel", "x"}},
          Json{{"op", "lamp_on"}, {"lamp", "left"}, {"on", "yes"}}})
        edit(change, 400);
    // Finite, but nowhere that a lamp can be.
    for (const char* op : {"move_lamp", "aim_lamp"})
        for (const Json& at : {Json{{"world", {1e300, 0, 0}}}, Json{{"pixel", {1e300, -1e300}}},
                               Json{{"pixel", {1e9, 0}}}}) {
            Json change{{"op", op}, {"lamp", "left"}};
            change.update(at);
            const auto answer =
                client_.Post(path("/api/edit"),
                             Json{{"revision", before["revision"]}, {"changes", {change}}}.dump(),
                             "application/json");
            EXPECT_TRUE(answer->status == 200 || answer->status == 400 || answer->status == 422)
                << change << answer->status << answer->body;
            if (answer->status == 200) post("/api/undo", Json::object());
        }
    const Json revision = get("/api/state")["revision"];
    const Json remove{{"op", "remove_lamp"}, {"lamp", "left"}};
    for (const Json& body :
         {Json::object(), Json{{"revision", revision}}, Json{{"changes", {remove}}},
          Json{{"revision", revision}, {"changes", Json::array()}},
          Json{{"revision", revision}, {"changes", remove}},
          Json{{"revision", "1"}, {"changes", {remove}}},
          Json{{"revision", 1.5}, {"changes", {remove}}},
          Json{{"revision", revision}, {"changes", Json::array_t(101, remove)}},
          Json{{"revision", revision}, {"changes", {remove}}, {"label", 1}},
          Json{{"revision", revision}, {"changes", {remove}}, {"group", Json::array()}}})
        post("/api/edit", body, 400);
    for (const Json& outrun : {Json(999), Json(-1), Json(std::numeric_limits<std::uint64_t>::max()),
                               Json(std::numeric_limits<std::int64_t>::min())})
        post("/api/edit", {{"revision", outrun}, {"changes", {remove}}}, 409);
    for (const Json& body : {Json{{"camera", "none"}}, Json{{"camera", 1}}, Json{{"frame", 1}},
                             Json{{"frame", "x"}}, Json{{"frame", 1e300}}})
        post("/api/show", body, 400);
    for (const Json& file : {Json(), Json(1), Json(""), Json("../x.yaml"), Json("/x.yaml"),
                             Json("x.txt"), Json(".x.yaml"), Json("a/b.yaml"), Json("a\nb.yaml"),
                             Json(std::string(300, 'x') + ".yaml")})
        post("/api/save_as", {{"file", file}}, 400);
    post("/api/save_as", {{"file", "x.yaml"}, {"overwrite", 1}}, 400);
    post("/api/save", {{"overwrite", "no"}}, 400);
    const Json suggestion{{"lamp", "left"}, {"along", {{"from", {-1, 0, 0}}, {"to", {0, 0, 0}}}}};
    const auto with = [&](const Json& more) {
        Json body = suggestion;
        body.update(more);
        return body;
    };
    for (const Json& body :
         {Json::object(), with({{"lamp", "none"}}), with({{"lamp", 1}}), with({{"mirror", "none"}}),
          with({{"mirror", "left"}}), with({{"along", Json::array()}}),
          with({{"along", {{"from", {0, 0, 0}}, {"to", {0, 0, 0}}}}}),
          with({{"along", {{"from", {0, 0, 0}}, {"to", {1e308, -1e308, 1e308}}}}}),
          with({{"box", {{"min", {0, 0, 0}}}}}), with({{"distance", 0}}), with({{"distance", -1}}),
          with({{"distance", "far"}}), with({{"objective", "beauty"}}), with({{"aim", 1}}),
          with({{"least_light", -1}}), with({{"samples", 11}}), with({{"samples", 1e300}}),
          with({{"samples", -1}})})
        post("/api/suggest", body, 400);
    post("/api/redo", Json::object(), get("/api/state")["can_redo"] == true ? 200 : 409);
    while (get("/api/state")["can_undo"] == true) post("/api/undo", Json::object());
    post("/api/undo", Json::object(), 409);
    get("/api/view", 409);
    ASSERT_TRUE(eventually([&] { return session_.picture() != nullptr; }));
    for (const char* address :
         {"/api/image?min=x", "/api/image?min=1e9", "/api/image?min=99999999999999999999",
          "/api/image?type=f64", "/api/numbers?ratio=x", "/api/numbers?ratio=nan",
          "/api/numbers?ratio=1e999", "/api/numbers?curves=yes", "/api/numbers?x0=-1",
          "/api/numbers?x0=1", "/api/numbers?x0=1&y0=1&x1=1&y1=1",
          "/api/numbers?x0=0&y0=0&x1=99999999999&y1=9", "/api/export/numbers.csv?ratio=x",
          "/api/export/picture.png?exposure=x", "/api/export/picture.png?exposure=-inf"})
        get(address, 400);
    Json now = whole_state(), was = before;
    // These count what was tried and undone; the outlines are made anew for each revision.
    for (const char* other : {"outlines", "revision", "can_redo", "redo_label"}) {
        now.erase(other);
        was.erase(other);
    }
    EXPECT_EQ(now, was);
}

/// A scene's file belongs to others, too: whoever has not seen what they wrote may not replace it
/// without saying so, with changes of their own or without.
TEST_F(EditServerTest, SavingAgainstAnotherProgramIsAConflict) {
    const auto text_of = [](const std::filesystem::path& file) {
        std::ifstream stream(file);
        return std::string{std::istreambuf_iterator<char>(stream), {}};
    };
    for (const bool is_unsaved : {false, true})
        for (const bool is_scene : {false, true}) {
            if (!is_unsaved && is_scene) continue;  // it is taken over at once
            SCOPED_TRACE(is_unsaved);
            if (is_unsaved)
                edit({{"op", "set"}, {"path", "render.samples"}, {"value", is_scene ? 5 : 6}});
            const std::string other =
                is_scene ? std::string(k_edit_scene) + "# other\n" : "uwvdb: [";
            folder_.write("rig.yaml", other);
            EXPECT_NE(post("/api/save", Json::object(), 409)["error"].get<std::string>().find(
                          "rig.yaml: has been changed by another program"),
                      std::string::npos);
            post("/api/save_as", {{"file", "rig.yaml"}}, 409);
            EXPECT_EQ(text_of(file_), other);
            EXPECT_EQ(post("/api/save", {{"overwrite", true}})["unsaved"], false);
            EXPECT_NE(text_of(file_), other);
        }
    folder_.write("there.yaml", "x");
    std::filesystem::create_symlink("there.yaml", folder_.path() / "link.yaml");
    std::filesystem::create_directory(folder_.path() / "folder.yaml");
    for (const char* name : {"there.yaml", "link.yaml", "folder.yaml"})
        post("/api/save_as", {{"file", name}}, 409);
    post("/api/save_as", {{"file", "link.yaml"}, {"overwrite", true}}, 409);
    post("/api/save_as", {{"file", "folder.yaml"}, {"overwrite", true}}, 422);
    EXPECT_EQ(text_of(folder_.path() / "there.yaml"), "x");
    std::filesystem::remove(file_);
    EXPECT_EQ(post("/api/save", Json::object())["deleted_on_disk"], false);
    EXPECT_TRUE(std::filesystem::exists(file_));
}

TEST_F(EditServerTest, ServesPicturesAndNumbers) {
    ASSERT_TRUE(eventually([&] {
        const auto answer = client_.Get(path("/api/image?type=f16"));
        return answer && answer->status == 200 &&
               answer->body.find("\"quality\":\"final\"") != std::string::npos;
    }));
    EXPECT_EQ(client_.Get(path("/api/image?min=1000"))->status, 204);
    const Json numbers = get("/api/numbers?x0=40&y0=20&x1=60&y1=40&curves=1");
    EXPECT_GT(numbers["image"]["signal"], 0);
    EXPECT_EQ(numbers["patch"]["kind"], "pixels");
    EXPECT_EQ(numbers["curves"]["distance"].size(), numbers["curves"]["contrast"].size());
    EXPECT_EQ(client_.Get(path("/api/numbers?x0=40&y0=20&x1=600&y1=40"))->status, 400);
    const auto csv = client_.Get(path("/api/export/numbers.csv"));
    EXPECT_EQ(csv->status, 200);
    EXPECT_TRUE(csv->body.starts_with("quantity,image,patch\n"));
    const auto png = client_.Get(path("/api/export/picture.png?exposure=2"));
    EXPECT_EQ(png->status, 200);
    EXPECT_TRUE(png->body.starts_with("\x89PNG"));
}

TEST_F(EditServerTest, TellsEveryWindow) {
    std::atomic<bool> is_told = false, is_ready = false;
    std::thread window([&] {
        httplib::Client other("127.0.0.1", server_.port());
        std::string all;
        other.Get(path("/api/events"), [&](const char* data, std::size_t size) {
            all.append(data, size);
            is_ready = is_ready || all.find("event: hello\n") != std::string::npos;
            is_told = all.find("event: state\ndata: {\"revision\":2}\n\n") != std::string::npos;
            return !is_told;
        });
    });
    EXPECT_TRUE(eventually([&] { return is_ready.load(); }));
    edit({{"op", "set"}, {"path", "lamps.left.position"}, {"value", {0, 1, 1}}});
    EXPECT_TRUE(eventually([&] { return is_told.load(); }));
    window.join();
}

TEST_F(EditServerTest, SearchesForABetterPlace) {
    EventLog& log = session_.events();
    const Json begun =
        post("/api/suggest", {{"lamp", "left"},
                              {"along", {{"from", {-1, 0, 0.6}}, {"to", {0, 0, 0.6}}}},
                              {"distance", 1.5},
                              {"samples", 15}});
    Json found;
    EXPECT_TRUE(eventually([&] {
        for (const Event& event : log.wait(0, 0.1))
            if (event.name == "suggest" && Json::parse(event.data)["state"] == "found")
                found = Json::parse(event.data);
        return !found.is_null();
    }));
    EXPECT_EQ(found["id"], begun["id"]);
    EXPECT_GE(found["best"]["value"], found["before"]["value"]);
    EXPECT_EQ(found["lamps"][0]["lamp"], "left");
    EXPECT_EQ(found["map"]["points"].size(), found["map"]["counts"][0].get<std::size_t>());
    post("/api/suggest/cancel", Json::object());
}

// 127.0.0.2 is another address of this machine, as a container's is of the network.
TEST_F(EditServerTest, ListensElsewhereOnlyIfPublished) {
    httplib::Client unheard("127.0.0.2", server_.port());
    EXPECT_FALSE(unheard.Get(path("/")));
    EditSession session(file_);
    const EditServer published(session, 0, EditAddress::everywhere);
    httplib::Client client("127.0.0.2", published.port());
    const std::string page = "/" + published.token() + "/";
    const auto other = client.Get(page);  // the Host is the address that it connects to
    ASSERT_TRUE(other);
    EXPECT_EQ(other->status, 403);
    const auto same = client.Get(page, {{"Host", "127.0.0.1:" + std::to_string(published.port())}});
    ASSERT_TRUE(same);
    EXPECT_EQ(same->status, 200);
    EXPECT_TRUE(published.address().starts_with("http://127.0.0.1:"));
}

TEST_F(EditServerTest, APortThatIsTakenIsAnError) {
    EXPECT_THROW(EditServer(session_, server_.port()), IoError);
}

}  // namespace
