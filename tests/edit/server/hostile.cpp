// ctest labels: unit threads
// What other pages and other programs may try on the server of the lamp editor.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include <chrono>
#include <string>
#include <vector>

#include "edit/server/edit_server.h"
#include "tests/support/edit_scene.h"
#include "tests/support/http_probe.h"
#include "tests/support/scene_folder.h"

namespace {

using namespace uw;
using namespace uw::test;

class HostileTest : public testing::Test {
  protected:
    std::string host() const { return fmt::format("127.0.0.1:{}", server_.port()); }
    std::string path(const std::string& rest) const { return "/" + server_.token() + rest; }
    // The status of the answer to a request that is sent as it is; on a slow machine it takes long.
    int answer_to(const std::string& request, double seconds = 600) const {
        HttpProbe probe(server_.port());
        probe.send(request);
        return status_of(probe.receive(seconds));
    }
    int get(const std::string& target, const std::string& headers) const {
        return answer_to("GET " + target + " HTTP/1.1\r\nConnection: close\r\n" + headers + "\r\n");
    }
    bool is_serving() const {
        httplib::Client client("127.0.0.1", server_.port());
        const auto answer = client.Get(path("/api/state"));
        return answer && answer->status == 200;
    }

    SceneFolder folder_;
    EditSession session_{folder_.write("rig.yaml", k_edit_scene)};
    EditServer server_{session_, 0};
};

TEST_F(HostileTest, TheTokenIsNeeded) {
    const std::string from_here = "Host: " + host() + "\r\n";
    EXPECT_EQ(get(path("/api/state"), from_here), 200);
    std::string other = server_.token();
    other.back() = other.back() == '0' ? '1' : '0';
    for (const std::string& target :
         {std::string("/"), std::string("/api/state"), "/" + other + "/api/state",
          "/" + server_.token(), "/" + server_.token() + "0/api/state",
          "//" + server_.token() + "/api/state", "/x/" + server_.token() + "/api/state"})
        EXPECT_EQ(get(target, from_here), 403) << target;
}

TEST_F(HostileTest, OtherPagesAreRefused) {
    const std::string target = path("/api/state"), here = "Host: " + host() + "\r\n";
    EXPECT_EQ(get(target, fmt::format("Host: localhost:{}\r\n", server_.port())), 200);
    EXPECT_EQ(get(target, here + "Origin: http://" + host() + "\r\n"), 200);
    // A name that was made to point here (DNS rebinding); none; another port's.
    EXPECT_EQ(get(target, "Host: evil.example\r\n"), 403);
    EXPECT_EQ(get(target, fmt::format("Host: evil.example:{}\r\n", server_.port())), 403);
    EXPECT_EQ(get(target, ""), 403);
    EXPECT_EQ(get(target, "Host: 127.0.0.1:1\r\n"), 403);
    for (const char* origin :
         {"http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1"})
        EXPECT_EQ(get(target, here + "Origin: " + origin + "\r\n"), 403) << origin;
    EXPECT_EQ(get(target, here + "Sec-Fetch-Site: cross-site\r\n"), 403);
    EXPECT_EQ(get(target, here + "Sec-Fetch-Site: same-origin\r\n"), 200);
}

TEST_F(HostileTest, NothingOutsideThePageIsServed) {
    for (const char* target : {"/page/../rig.yaml", "/page/%2e%2e/rig.yaml", "/page/..%2frig.yaml",
                               "/../../etc/passwd", "/page//etc/passwd", "/page/%2fetc%2fpasswd",
                               "/page/index.html%00.js", "/rig.yaml", "/page/", "/page/."})
        EXPECT_EQ(get(path(target), "Host: " + host() + "\r\n"), 404) << target;
}

TEST_F(HostileTest, WhatIsNoRequestIsRefused) {
    EXPECT_EQ(answer_to("hello\r\n\r\n"), 400);
    EXPECT_EQ(answer_to("\r\n\r\n"), 400);
    EXPECT_EQ(answer_to(std::string("\0\x01\x02\xff\r\n\r\n", 8)), 400);
    EXPECT_EQ(answer_to("GET /" + std::string(5000, 'a') + " HTTP/1.1\r\n\r\n"), 414);
    // A header that is longer than any that a browser sends.
    EXPECT_EQ(answer_to("GET / HTTP/1.1\r\nA: " + std::string(17000, 'a') + "\r\n\r\n"), 400);
    EXPECT_TRUE(is_serving());
}

TEST_F(HostileTest, BodiesAreBounded) {
    const auto post = [&](const std::string& target, std::size_t bytes) {
        return fmt::format(
            "POST {} HTTP/1.1\r\nHost: {}\r\nContent-Type: application/json\r\n"
            "Content-Length: {}\r\nConnection: close\r\n\r\n",
            target, host(), bytes);
    };
    // None of them comes; without the token none is waited for.
    EXPECT_EQ(answer_to(post(path("/api/edit"), 300000)), 413);
    EXPECT_EQ(answer_to(post(path("/api/edit"), 1ULL << 60)), 413);
    EXPECT_EQ(answer_to(post("/api/edit", 1)), 403);
    EXPECT_EQ(
        answer_to(fmt::format("POST {} HTTP/1.1\r\nHost: {}\r\nTransfer-Encoding: chunked\r\n\r\n",
                              path("/api/edit"), host())),
        411);
    // Much more is sent than was said.
    EXPECT_EQ(answer_to(post(path("/api/edit"), 300000) + std::string(4000000, 'x')), 413);
    EXPECT_TRUE(is_serving());
}

TEST_F(HostileTest, SlowClientsTimeOut) {
    // A line that is never finished, and a body that never comes.
    HttpProbe unfinished(server_.port()), without_body(server_.port());
    unfinished.send("GET /");
    without_body.send("POST " + path("/api/edit") + " HTTP/1.1\r\nHost: " + host() +
                      "\r\nContent-Length: 10\r\n\r\n{");
    EXPECT_EQ(unfinished.receive(600), "");
    EXPECT_TRUE(unfinished.is_closed());
    EXPECT_EQ(status_of(without_body.receive(600)), 400);
    EXPECT_TRUE(is_serving());
}

// Whoever has something to say is served at once, whatever the number of connections that say
// nothing.
TEST_F(HostileTest, SilentConnectionsDisturbNobody) {
    std::vector<HttpProbe> silent;
    for (int i = 0; i < 1000; ++i) silent.emplace_back(server_.port());
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(is_serving());
    // Each of them would have kept a thread for longer.
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    EXPECT_EQ(status_of([&] {
                  silent.front().send("GET / HTTP/1.1\r\n\r\n");
                  return silent.front().receive(600);
              }()),
              403);
}

// Connections that begin to say something and stop keep others waiting until they time out.
TEST_F(HostileTest, UnfinishedRequestsDisturbNobodyForLong) {
    std::vector<HttpProbe> unfinished;
    for (int i = 0; i < 100; ++i) {
        unfinished.emplace_back(server_.port());
        unfinished.back().send("GET /slowly");
    }
    EXPECT_TRUE(eventually([&] { return is_serving(); }));
}

// Clients that ask for much and read nothing of it hold no one else up.
TEST_F(HostileTest, ClientsThatDoNotReadDisturbNobody) {
    std::vector<HttpProbe> deaf;
    const std::string request =
        "GET " + path("/api/image") + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n";
    ASSERT_TRUE(eventually([&] { return session_.picture() != nullptr; }));
    for (int i = 0; i < 20; ++i) {
        deaf.emplace_back(server_.port());
        for (int j = 0; j < 20; ++j) deaf.back().send(request);
    }
    EXPECT_TRUE(is_serving());
}

// The seventeenth window is told so.
TEST_F(HostileTest, WindowsAreBounded) {
    const std::string request =
        "GET " + path("/api/events") + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n";
    std::vector<HttpProbe> windows;
    for (int i = 0; i < 16; ++i) {
        windows.emplace_back(server_.port());
        windows.back().send(request);
        EXPECT_EQ(status_of(windows.back().receive(300, "hello")), 200);
    }
    HttpProbe late(server_.port());
    late.send(request);
    EXPECT_EQ(status_of(late.receive(300, "error")), 503);
    EXPECT_TRUE(is_serving());
}

}  // namespace
