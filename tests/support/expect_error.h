#pragma once

#include <initializer_list>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"

namespace mote {

/// Message of the Error that f throws; fails the test if it throws none, or another code, or more
/// than one line.
template <class F>
std::string error_message(F&& f, ExitCode code = ExitCode::Input)
{
    try {
        f();
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message;
    }
    ADD_FAILURE() << "no error was thrown";
    return "";
}

/// Expects an Error of f with this code whose message holds every one of `parts`.
template <class F>
void expect_error(F&& f, ExitCode code, std::initializer_list<const char*> parts)
{
    const std::string message = error_message(f, code);
    for (const char* part : parts) {
        EXPECT_NE(message.find(part), std::string::npos) << "no \"" << part << "\" in: " << message;
    }
}

}  // namespace mote
