// ctest labels: unit threads
// What other pages and other programs may try on the server of the lamp editor.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <httplib.h>

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
    // Idle connections stay longer than any test lasts.
    EditServer server_{
        session_, 0, {.connections = 64, .request_seconds = 0.5, .idle_seconds = 100000}};
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
    EXPECT_EQ(answer_to("GET / HTTP/1.1\r\n" + std::string(17000, 'a')), 431);
    std::string many = "GET / HTTP/1.1\r\n";
    for (int i = 0; i < 2000; ++i) many += fmt::format("A{}: b\r\n", i);
    EXPECT_EQ(answer_to(many + "\r\n"), 431);
    EXPECT_TRUE(is_serving());
}

TEST_F(HostileTest, BodiesAreBounded) {
    const auto post = [&](const std::string& target, std::size_t bytes) {
        return fmt::format(
            "POST {} HTTP/1.1\r\nHost: {}\r\nContent-Type: application/json\r\n"
            "Content-Length: {}\r\nConnection: close\r\n\r\n",
            target, host(), bytes);
    };
    // Refused before a byte of them has come; without the token, any.
    EXPECT_EQ(answer_to(post(path("/api/edit"), 300000)), 413);
    EXPECT_EQ(answer_to(post(path("/api/edit"), 1ULL << 60)), 413);
    EXPECT_EQ(answer_to(post("/api/edit", 1)), 413);
    EXPECT_EQ(
        answer_to("POST " + path("/api/edit") + " HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"),
        411);
    // Much more is sent than was said.
    EXPECT_EQ(answer_to(post(path("/api/edit"), 300000) + std::string(4000000, 'x')), 413);
    EXPECT_TRUE(is_serving());
}

TEST_F(HostileTest, SlowClientsTimeOut) {
    // A byte now and then: the whole request is to come within 0.5 s.
    HttpProbe slow(server_.port());
    slow.send("GET /");
    bool is_taken = true;
    std::string answer;
    while (is_taken && answer.empty()) {
        answer = slow.receive(0.05);
        is_taken = slow.send("a");
    }
    EXPECT_EQ(status_of(answer), 408);
    // A body that never comes.
    EXPECT_EQ(answer_to("POST " + path("/api/edit") + " HTTP/1.1\r\nHost: " + host() +
                        "\r\nContent-Length: 10\r\n\r\n{"),
              408);
    EXPECT_TRUE(is_serving());
}

// Ten times as many connections as are kept, all of them silent: whoever has something to say is
// served all the same, at once.
TEST_F(HostileTest, AThousandConnectionsDisturbNobody) {
    std::vector<HttpProbe> idle;
    for (int i = 0; i < 500; ++i) idle.emplace_back(server_.port());
    for (int i = 0; i < 500; ++i) {
        idle.emplace_back(server_.port());
        idle.back().send("GET /slowly");
    }
    EXPECT_TRUE(is_serving());
    std::size_t closed = 0;
    for (HttpProbe& probe : idle) {
        probe.receive(0.01);
        if (probe.is_closed()) ++closed;
    }
    EXPECT_GE(closed, 1000 - 64U);
    EXPECT_TRUE(is_serving());
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
