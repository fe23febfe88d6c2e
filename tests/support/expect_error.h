#pragma once

#include <string>

#include <gtest/gtest.h>

#include "core/error.h"

namespace mote::test {

/// Runs f and expects an Error with this code whose message holds every one of `parts`. Returns
/// the message.
template <class F>
std::string expect_error(F&& f, ExitCode code, std::initializer_list<const char*> parts)
{
    try {
        f();
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << message;
        for (const char* part : parts) {
            EXPECT_NE(message.find(part), std::string::npos)
                << "no \"" << part << "\" in: " << message;
        }
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message;
    }
    ADD_FAILURE() << "no error was thrown";
    return "";
}

}  // namespace mote::test
