// ctest labels: unit
#include "edit/server/http_server.h"

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace uw;

TEST(HttpHead, IsReadOnceItIsComplete) {
    const std::string text =
        "POST /a/b?c=d HTTP/1.1\r\nHost: x\r\ncontent-LENGTH: \t12 \r\n\r\n{\"a\": 1}";
    const std::size_t end = text.find("\r\n\r\n") + 4;
    for (std::size_t size = 0; size < end; ++size)
        EXPECT_FALSE(read_http_head(text.substr(0, size)).is_complete);
    const HttpHeadResult result = read_http_head(text);
    EXPECT_TRUE(result.is_complete);
    EXPECT_EQ(result.refusal, 0);
    EXPECT_EQ(result.head.bytes, end);
    EXPECT_EQ(result.head.method, "POST");
    EXPECT_EQ(result.head.target, "/a/b?c=d");
    EXPECT_EQ(result.head.body_bytes, 12U);
}

TEST(HttpHead, IsRefusedWhereItIsNone) {
    const auto refusal = [](const std::string& head) {
        return read_http_head(head + "\r\n\r\n").refusal;
    };
    for (const char* head :
         {"", "GET", "GET /", "GET / HTTP/2.0", "GET / HTTP/1.1x", "GET x HTTP/1.1",
          "GET /a b HTTP/1.1", "GET /\x01 HTTP/1.1", "GET /\xc3\xa4 HTTP/1.1",
          "GET / HTTP/1.1\r\nno colon", "GET / HTTP/1.1\r\n: nameless",
          "GET / HTTP/1.1\r\nContent-Length: -1", "GET / HTTP/1.1\r\nContent-Length: 1x",
          "GET / HTTP/1.1\r\nContent-Length: 99999999999999999999999",
          // Two lengths: which of them another reader takes is anyone's guess.
          "GET / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 1"})
        EXPECT_EQ(refusal(head), 400) << head;
    EXPECT_EQ(refusal("POST / HTTP/1.1\r\nTransfer-Encoding: chunked"), 411);
    EXPECT_EQ(refusal("GET /" + std::string(1999, 'a') + " HTTP/1.1"), 0);
    EXPECT_EQ(refusal("GET /" + std::string(2000, 'a') + " HTTP/1.1"), 414);
}

}  // namespace
