// ctest labels: unit threads
#include "edit/server/edit_server.h"

#include <gtest/gtest.h>
#include <httplib.h>

#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>

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

TEST_F(EditServerTest, RefusalsChangeNothing) {
    // The outlines come with the first picture.
    const auto state = [&] {
        Json all = get("/api/state");
        all.erase("outlines");
        return all;
    };
    const Json before = state();
    EXPECT_NE(edit({{"op", "set"}, {"path", "water.preset"}, {"value", "puddle"}}, 422)["error"]
                  .get<std::string>()
                  .find("unknown value 'puddle'"),
              std::string::npos);
    edit({{"op", "explode"}}, 400);
    post("/api/undo", Json::object(), 409);
    post("/api/edit", {{"revision", 99}, {"changes", {{{"op", "remove_lamp"}, {"lamp", "left"}}}}},
         409);
    post("/api/save_as", {{"file", "../x.yaml"}}, 400);
    get("/api/none", 404);
    get("/api/undo", 405);
    post("/api/state", Json::object(), 405);
    const auto raw = [&](const std::string& body, const char* type) {
        return client_.Post(path("/api/edit"), body, type)->status;
    };
    EXPECT_EQ(raw("{", "application/json"), 400);
    EXPECT_EQ(raw("[]", "application/json"), 400);
    EXPECT_EQ(raw("\xff\xfe", "application/json"), 400);
    EXPECT_EQ(raw(std::string(100000, '['), "application/json"), 400);
    EXPECT_EQ(raw("{}", "text/plain"), 415);
    EXPECT_EQ(raw("a=b", "application/x-www-form-urlencoded"), 415);
    EXPECT_EQ(raw(std::string(256 * 1024 + 1, ' '), "application/json"), 413);
    EXPECT_EQ(client_.Put(path("/api/state"), "x", "text/plain")->status, 405);
    EXPECT_EQ(client_.Delete(path("/api/state"))->status, 405);
    EXPECT_EQ(client_.Options(path("/api/state"))->status, 405);
    EXPECT_EQ(state(), before);
}

TEST_F(EditServerTest, ServesPicturesAndNumbers) {
    ASSERT_TRUE(eventually([&] {
        const auto answer = client_.Get(path("/api/image?type=f16"));
        return answer && answer->status == 200 &&
               answer->body.find("\"quality\":\"final\"") != std::string::npos;
    }));
    EXPECT_EQ(client_.Get(path("/api/image?min=1000"))->status, 204);
    EXPECT_EQ(client_.Get(path("/api/image?min=x"))->status, 400);
    EXPECT_EQ(client_.Get(path("/api/image?type=f64"))->status, 400);
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
    post("/api/suggest", {{"lamp", "none"}}, 400);
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
