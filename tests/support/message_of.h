#pragma once

#include <gtest/gtest.h>

#include <string>

namespace uw::test {

/// The message of the `Error` that `action` throws, which must be one line; fails the test, and
/// returns "", if it is not or nothing is thrown.
template <class Error, class Action>
std::string message_of(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message;
    } catch (const std::exception& error) {
        ADD_FAILURE() << "another kind of exception: " << error.what();
        return "";
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

}  // namespace uw::test
